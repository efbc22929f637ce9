#include "sim/motion_audit.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/kinematics/inverse_kinematics.h"
#include "common/runtime/error.h"
#include "sim/pose_error.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

TrajectoryPoint MakePoint(int64_t time_us, const Vector3d& p_W) {
  return {time_us, MakePose(p_W, Eigen::Quaterniond::Identity()), {}, false};
}

/// A sensor by itself: one sphere of 50 mm, 0.25 m/s.
RunConfig MakeFreeRun() {
  RunConfig config;
  config.cell.sensor_body_S = {{Vector3d::Zero(), 0.05}};
  return config;
}

/// What a robot that does as it is told reports: a state at the first and one at the last point.
ExecutedMotion Execute(const std::vector<TrajectoryPoint>& points, int64_t start_us = 0, int32_t scan = 0) {
  ExecutedMotion motion{{start_us, scan, points}, {}, true};
  for (const TrajectoryPoint& point : {points.front(), points.back()})
    motion.states.push_back({start_us + point.time_us, scan, point.scanning, false, point.X_WF, point.joints_rad});
  return motion;
}

MotionAudit AuditMotion(const RunConfig& config, const TriangleMesh& object_W, const ExecutedMotion& motion) {
  MotionAuditor auditor(object_W, config);
  auditor.Look(motion);
  return auditor.audit();
}

TEST(MotionAudit, FreeWayHasNoFaultAndItsNearestDistance) {
  const MotionAudit audit = AuditMotion(MakeFreeRun(), MakeSphere(0.1f, 5),
                                        Execute({MakePoint(0, {-0.5, 0, 0.19}), MakePoint(5'000'000, {0.5, 0, 0.19})}));
  EXPECT_EQ(audit.CountAll(), 0);
  EXPECT_EQ(audit.contacts, 0);
  EXPECT_GE(audit.states, 101);
  EXPECT_NEAR(audit.nearest_m, 0.04, 0.001);
  ASSERT_TRUE(audit.nearest);
  EXPECT_NEAR(1e-6 * static_cast<double>(audit.nearest->utime_us), 2.5, 0.1);
  EXPECT_DOUBLE_EQ(audit.move_s, 5.0);
}

TEST(MotionAudit, SensorThatPassesThroughTheObjectTouchesItBetweenThePoints) {
  const MotionAudit audit = AuditMotion(MakeFreeRun(), MakeSphere(0.1f, 5),
                                        Execute({MakePoint(0, {-0.5, 0, 0}), MakePoint(5'000'000, {0.5, 0, 0})}, 7, 3));
  const MotionFaultCount& touching = audit.of(MotionFault::kContactObject);
  // From 0.15 m before the middle to as far after it, the stretch wholly inside included: 0.3 m in steps of 10 mm.
  EXPECT_NEAR(static_cast<double>(touching.count), 31.0, 1.0);
  EXPECT_EQ(audit.contacts, touching.count);
  ASSERT_TRUE(touching.first);
  EXPECT_EQ(touching.first->scan, 3);
  EXPECT_EQ(touching.first->body, "sensor");
  EXPECT_NEAR(1e-6 * static_cast<double>(touching.first->utime_us), 0.35 / 0.2, 0.06);
  EXPECT_LT(audit.nearest_m, -0.03);
}

TEST(MotionAudit, BodyWhollyInsideTheObjectTouchesIt) {
  const MotionAudit audit = AuditMotion(MakeFreeRun(), MakeSphere(0.3f, 4),
                                        Execute({MakePoint(0, {0, 0, 0}), MakePoint(1'000'000, {0, 0, 0})}));
  EXPECT_GE(audit.of(MotionFault::kContactObject).count, 2);
}

TEST(MotionAudit, TableIsSolidAndEndsAtItsEdge) {
  RunConfig config = MakeFreeRun();
  config.cell.table_z_m = -0.2;
  config.cell.table_half_m = {0.3, 0.3};
  const auto count = [&](const Vector3d& p_W) {
    return AuditMotion(config, MakeSphere(0.1f, 4), Execute({MakePoint(0, p_W), MakePoint(1000, p_W)}))
        .of(MotionFault::kContactTable)
        .count;
  };
  EXPECT_GT(count({0.2, 0, -0.16}), 0);
  EXPECT_GT(count({0.33, 0, -0.5}), 0);
  EXPECT_EQ(count({0.2, 0, -0.14}), 0);
  EXPECT_EQ(count({0.36, 0, -0.5}), 0);
}

TEST(MotionAudit, FlangeThatIsTooFastOrJumpsIsNamed) {
  const TriangleMesh far = MakeSphere(0.1f, 2);
  const auto audit_of = [&](const std::vector<TrajectoryPoint>& points) {
    return AuditMotion(MakeFreeRun(), far, Execute(points));
  };
  const MotionAudit fast = audit_of({MakePoint(0, {1, 0, 0}), MakePoint(100'000, {1, 0, 0.027})});
  ASSERT_EQ(fast.of(MotionFault::kSpeed).count, 1);
  EXPECT_EQ(fast.of(MotionFault::kSpeed).first->body, "flange");
  EXPECT_EQ(fast.of(MotionFault::kJump).count, 0);
  EXPECT_EQ(audit_of({MakePoint(0, {1, 0, 0}), MakePoint(100'000, {1, 0, 0.025})}).CountAll(), 0);
  const MotionAudit jumping = audit_of({MakePoint(0, {1, 0, 0}), MakePoint(100'000, {1, 0, 0.1})});
  EXPECT_EQ(jumping.of(MotionFault::kJump).count, 1);
  EXPECT_EQ(jumping.of(MotionFault::kSpeed).count, 0);
}

TEST(MotionAudit, ScanningSensorKeepsItsOwnSpeed) {
  std::vector<TrajectoryPoint> points = {MakePoint(0, {1, 0, 0}), MakePoint(1'000'000, {1, 0, 0.06})};
  const TriangleMesh far = MakeSphere(0.1f, 2);
  EXPECT_EQ(AuditMotion(MakeFreeRun(), far, Execute(points)).CountAll(), 0);
  points[0].scanning = points[1].scanning = true;
  const MotionAudit audit = AuditMotion(MakeFreeRun(), far, Execute(points));
  ASSERT_GE(audit.of(MotionFault::kSpeed).count, 1);
  EXPECT_EQ(audit.of(MotionFault::kSpeed).first->body, "sensor");
  EXPECT_DOUBLE_EQ(audit.scan_s, 1.0);
}

TEST(MotionAudit, RobotThatIsNotWhereItsTrajectorySaysJumps) {
  ExecutedMotion motion = Execute({MakePoint(0, {1, 0, 0}), MakePoint(1'000'000, {1, 0, 0.2})});
  RobotState off = motion.states.front();
  off.utime_us = 500'000;
  off.X_WF.translation() = Vector3d(1, 0, 0.3);
  motion.states.insert(motion.states.begin() + 1, off);
  EXPECT_GE(AuditMotion(MakeFreeRun(), MakeSphere(0.1f, 2), motion).of(MotionFault::kJump).count, 1);
}

TEST(MotionAudit, MotionThatBeginsElsewhereJumps) {
  MotionAuditor auditor(MakeSphere(0.1f, 2), MakeFreeRun());
  auditor.Look(Execute({MakePoint(0, {1, 0, 0}), MakePoint(1'000'000, {1, 0, 0.2})}));
  auditor.Look(Execute({MakePoint(0, {1, 0, 0.2}), MakePoint(1'000'000, {1, 0, 0})}, 1'040'000, 1));
  EXPECT_EQ(auditor.audit().CountAll(), 0);
  auditor.Look(Execute({MakePoint(0, {1, 0, 0.3}), MakePoint(1'000'000, {1, 0, 0.3})}, 2'080'000, 2));
  const MotionFaultCount& jumps = auditor.audit().of(MotionFault::kJump);
  ASSERT_EQ(jumps.count, 1);
  EXPECT_EQ(jumps.first->scan, 2);
}

TEST(MotionAudit, RefusedTrajectoryIsNoMotion) {
  ExecutedMotion motion = Execute({MakePoint(0, {-0.5, 0, 0}), MakePoint(1'000'000, {0.5, 0, 0})});
  motion.done = false;
  motion.states.resize(1);
  EXPECT_EQ(AuditMotion(MakeFreeRun(), MakeSphere(0.1f, 4), motion).CountAll(), 0);
}

/// The KR 16 before a ball where the object stands.
class ArmAudit : public ::testing::Test {
 protected:
  ArmAudit() {
    config_.cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/kr16.yaml");
    ResolvePlacement({Vector3d(-0.1, -0.1, -0.1), Vector3d(0.1, 0.1, 0.1)}, config_);
    robot_.emplace(config_);
  }

  TrajectoryPoint MakeArmPoint(int64_t time_us, const Joints& q) const {
    return {time_us, robot_->MakePosture(time_us, q, false).X_WF, {q.begin(), q.end()}, false};
  }

  Joints MakeStart() const {
    const std::vector<double>& start = config_.cell.arm->start_rad;
    return Eigen::Map<const Eigen::VectorXd>(start.data(), 6);
  }

  /// Joint values with the sensor's window at `p_W`, looking along +x.
  Joints FindJoints(const Vector3d& p_W) const {
    const Pose X_WS = MakeLookPose(p_W, Vector3d::UnitX(), Vector3d::UnitZ());
    const auto reached = InverseKinematics(*robot_->arm(), IkMethod::kAnalytic)
                             .FindAll(robot_->X_WB().inverse() * X_WS * config_.cell.X_FS.inverse());
    if (reached.empty()) throw std::invalid_argument("ArmAudit: out of reach");
    return reached.front();
  }

  /// Slow enough, from the start to `q` and there.
  MotionAudit AuditWay(const Joints& q, const TriangleMesh& object_W) const {
    return AuditMotion(config_, object_W, Execute({MakeArmPoint(0, MakeStart()), MakeArmPoint(60'000'000, q)}));
  }

  RunConfig config_;
  std::optional<RobotBody> robot_;
};

TEST_F(ArmAudit, ArmAtItsStartTouchesNothing) { EXPECT_EQ(AuditWay(MakeStart(), MakeSphere(0.1f, 4)).CountAll(), 0); }

TEST_F(ArmAudit, ArmThatIsDrivenThroughTheObjectTouchesItWithTheSensorFirst) {
  const MotionAudit audit = AuditWay(FindJoints({0.05, 0, 0.05}), MakeSphere(0.1f, 5));
  EXPECT_GT(audit.contacts, 5);
  ASSERT_TRUE(audit.of(MotionFault::kContactObject).first);
  EXPECT_EQ(audit.of(MotionFault::kContactObject).first->body, "sensor");
}

TEST_F(ArmAudit, CellThatStartsWithTooFewJointsIsRefused) {
  config_.cell.arm->start_rad.pop_back();
  EXPECT_THROW(MotionAuditor(MakeSphere(0.1f, 3), config_), ConfigError);
}

TEST_F(ArmAudit, StateWithAnotherNumberOfJointsIsRefusedAndNotRead) {
  for (const size_t joints : {0, 5, 7, 9, 30}) {
    ExecutedMotion motion = Execute({MakeArmPoint(0, MakeStart()), MakeArmPoint(1000, MakeStart())});
    motion.states[1].joints_rad.assign(joints, 0.1);
    MotionAuditor auditor(MakeSphere(0.1f, 3), config_);
    EXPECT_THROW(auditor.Look(motion), std::invalid_argument) << joints;
  }
}

TEST_F(ArmAudit, LinksTouchAsWellAsTheSensor) {
  // A ball of 100 mm around the middle of each moving link at the start; the arm stands still.
  LinkPoses X_BL;
  CalcLinkPoses(*robot_->arm(), MakeStart(), X_BL);
  for (const int link : {1, 2, 3, 4, 5, 6}) {
    const ArmLink& body = robot_->arm()->links[static_cast<size_t>(link)];
    const Vector3d p_L = body.capsules.empty() ? Vector3d(body.blocks[0].X_LC.translation()) : body.capsules[0].p_A;
    TriangleMesh ball = MakeSphere(0.1f, 3);
    const Vector3d p_W = robot_->X_WB() * X_BL[static_cast<size_t>(link)] * p_L;
    for (auto& vertex : ball.vertices_W) vertex += p_W.cast<float>();
    MotionAuditor auditor(ball, config_);
    auditor.Look(Execute({MakeArmPoint(0, MakeStart()), MakeArmPoint(1000, MakeStart())}));
    EXPECT_GT(auditor.audit().of(MotionFault::kContactObject).count, 0) << link;
  }
}

TEST_F(ArmAudit, ArmThatReachesIntoTableFloorOrItselfIsNamed) {
  const TriangleMesh object = MakeSphere(0.1f, 3);
  Joints down = MakeStart();
  down[1] = 0.4;
  down[2] = 0.6;
  const MotionAudit low = AuditWay(down, object);
  EXPECT_GT(low.of(MotionFault::kContactTable).count + low.of(MotionFault::kContactFloor).count, 0);
  Joints folded = MakeStart();
  folded[1] = -0.5;
  folded[2] = 2.68;
  folded[4] = 2.2;
  const MotionAudit self = AuditWay(folded, object);
  ASSERT_GT(self.of(MotionFault::kContactSelf).count, 0);
  EXPECT_NE(self.of(MotionFault::kContactSelf).first->body.find(" and "), std::string::npos);
}

TEST_F(ArmAudit, JointBeyondItsLimitTooFastOrJumpingIsNamed) {
  const TriangleMesh object = MakeSphere(0.1f, 3);
  Joints beyond = MakeStart();
  beyond[4] = 2.3;
  const MotionAudit limit = AuditWay(beyond, object);
  ASSERT_EQ(limit.of(MotionFault::kJointLimit).count, 2);  // its last state and its last point
  EXPECT_EQ(limit.of(MotionFault::kJointLimit).first->body, "joint_a5");
  // 2.72 rad/s is the limit of joint 1.
  Joints turned = MakeStart();
  turned[0] += 0.29;
  const auto within = [&](int64_t time_us) {
    return AuditMotion(config_, object, Execute({MakeArmPoint(0, MakeStart()), MakeArmPoint(time_us, turned)}));
  };
  config_.cell.move_speed_m_per_s = 100.0;
  config_.cell.turn_speed_rad_per_s = 100.0;
  EXPECT_EQ(within(110'000).CountAll(), 0);
  EXPECT_EQ(within(100'000).of(MotionFault::kSpeed).count, 1);
  EXPECT_EQ(within(100'000).of(MotionFault::kSpeed).first->body, "joint_a1");
  EXPECT_EQ(within(50'000).of(MotionFault::kJump).count, 1);
}

TEST_F(ArmAudit, FirstMotionBeginsWhereTheCellSaysThatTheArmRests) {
  Joints elsewhere = MakeStart();
  elsewhere[0] += 0.5;
  const MotionAudit audit =
      AuditMotion(config_, MakeSphere(0.1f, 3), Execute({MakeArmPoint(0, elsewhere), MakeArmPoint(1000, elsewhere)}));
  EXPECT_EQ(audit.of(MotionFault::kJump).count, 1);
}

TEST_F(ArmAudit, ContactIsJudgedAtTheTruePoseAndNotAtTheReportedOne) {
  // A wall before the sensor, so near that only the pose error decides.
  config_.cell.arm->pose_noise_m = 0.0;
  const Joints q = FindJoints({-0.3, 0, 0.1});
  const Posture posture = robot_->MakePosture(0, q, false);
  const double off_x =
      PoseError::Make(config_).CalcTruePose(posture.X_WF, 0).translation().x() - posture.X_WF.translation().x();
  ASSERT_GT(std::abs(off_x), 2e-4);
  double front_x = -1e9;
  for (const PlacedPart& part : robot_->Place(posture, Vector3d::Zero())) {
    for (const Capsule& c : part.capsules_W)
      front_x = std::max({front_x, c.p_A.x() + c.radius_m, c.p_B.x() + c.radius_m});
  }
  const auto touches_wall_at = [&](double x) {
    TriangleMesh wall;
    for (const auto& [y, z] : {std::pair{-3.f, -3.f}, {3.f, -3.f}, {3.f, 3.f}, {-3.f, 3.f}})
      wall.vertices_W.emplace_back(static_cast<float>(x), y, z);
    wall.triangles = {{0, 2, 1}, {0, 3, 2}};
    config_.cell.arm->start_rad.assign(q.begin(), q.end());
    return AuditMotion(config_, wall, Execute({MakeArmPoint(0, q), MakeArmPoint(1, q)}))
               .of(MotionFault::kContactObject)
               .count > 0;
  };
  EXPECT_TRUE(touches_wall_at(front_x + off_x - 1e-4));
  EXPECT_FALSE(touches_wall_at(front_x + off_x + 1e-4));
}

}  // namespace
}  // namespace nbs
