#include "services/planner/motion_planning/arm_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/runtime/error.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "services/robot/arm_check.h"
#include "tests/common/kinematics/arms.h"
#include "tests/services/planner/motion_planning/arm_cases.h"

namespace nbs {
namespace {

using testing::HasSubstr;

/// All that a trajectory promises: the robot takes it, and nothing is touched anywhere on it.
void ExpectSafe(const RunConfig& config, const Clearance& world, const RobotPosture& now, const MotionResult& result) {
  const ArmLimits limits = MakeArmLimits(config);
  const ArmCollision collision(config, limits.model);
  const Joints q_now = Eigen::Map<const Eigen::VectorXd>(now.joints_rad.data(), limits.model.n());
  EXPECT_EQ(FindArmRefusal(result.trajectory, q_now, limits), "");
  for (int64_t time_us = 0; time_us <= result.trajectory.points.back().time_us; time_us += 5000) {
    const Joints q = CalcJointValues(result.trajectory, time_us);
    ASSERT_TRUE(collision.IsFree(world, q, 0.5 * kArmSweepTolerance)) << time_us;
    LinkPoses X_BL;
    CalcLinkPoses(limits.model, q, X_BL);
    ASSERT_GE(collision.body().CalcSelfDistance(X_BL, 1.0), kSelfMargin - 0.5 * kArmSweepTolerance) << time_us;
  }
}

TEST(ArmMotion, GoesRoundTheObjectAndScansTouchingNothing) {
  const RunConfig config = MakeKr16Run();
  const BoxWorld world = MakeObjectWorld();
  const MotionPlanner planner(config);
  RobotPosture now = planner.MakeStartPosture(config.first_path);
  int found = 0;
  for (int k = 0; k < 12; ++k) {
    const MotionResult result = planner.Plan(world, now, MakePathAbout(0.5 * k), 7);
    if (!result.found()) continue;
    ++found;
    ExpectSafe(config, world, now, result);
    const TrajectoryPoint& last = result.trajectory.points.back();
    now = {last.X_WF * config.cell.X_FS, last.joints_rad};
  }
  EXPECT_GE(found, 9);
}

TEST(ArmMotion, ScansAlongThePathThatItSays) {
  const RunConfig config = MakeKr16Run();
  const MotionPlanner planner(config);
  const MotionResult result =
      planner.Plan(MakeObjectWorld(), planner.MakeStartPosture(config.first_path), MakePathAbout(3.0), 7);
  ASSERT_TRUE(result.found());
  const ScanPath& path = result.path;
  const Eigen::Vector3d along_W = (path.X_WS_end.translation() - path.X_WS_start.translation()).normalized();
  for (const TrajectoryPoint& point : result.trajectory.points) {
    if (!point.scanning) continue;
    const Pose X_WS = point.X_WF * config.cell.X_FS;
    const Eigen::Vector3d off = X_WS.translation() - path.X_WS_start.translation();
    EXPECT_LT((off - along_W * along_W.dot(off)).norm(), 0.0005);
    EXPECT_LT(CalcAngleBetween(X_WS, path.X_WS_start), 0.005);
  }
}

TEST(ArmMotion, SameRequestGivesTheSameTrajectory) {
  const RunConfig config = MakeKr16Run();
  const MotionPlanner planner(config);
  const RobotPosture now = planner.MakeStartPosture(config.first_path);
  const MotionResult a = planner.Plan(MakeObjectWorld(), now, MakePathAbout(0.0), 7);
  (void)planner.Plan(MakeObjectWorld(), now, MakePathAbout(1.0), 8);
  const MotionResult b = MotionPlanner(config).Plan(MakeObjectWorld(), now, MakePathAbout(0.0), 7);
  ASSERT_EQ(a.trajectory.points.size(), b.trajectory.points.size());
  for (size_t k = 0; k < a.trajectory.points.size(); ++k) {
    EXPECT_EQ(a.trajectory.points[k].time_us, b.trajectory.points[k].time_us);
    EXPECT_EQ(a.trajectory.points[k].joints_rad, b.trajectory.points[k].joints_rad);
  }
}

TEST(ArmMotion, SearchesAWayRoundAWall) {
  const RunConfig config = MakeKr16Run();
  BoxWorld world;
  // Between the arm's side of the object and the far side only the way over the top or round the ends is free.
  world.occupied.push_back(MakeBox({-0.02, -0.3, 0.0}, {0.02, 0.3, 0.45}));
  const MotionPlanner planner(config);
  const MotionResult one =
      planner.Plan(world, planner.MakeStartPosture(config.first_path), MakePathAbout(2.0, 0.5, 0.25), 7);
  ASSERT_TRUE(one.found());
  const TrajectoryPoint& last = one.trajectory.points.back();
  const RobotPosture now{last.X_WF * config.cell.X_FS, last.joints_rad};
  int found = 0;
  for (const double angle : {0.6, 0.9, 5.4, 5.7}) {
    const MotionResult result = planner.Plan(world, now, MakePathAbout(angle, 0.45, 0.3), 7);
    if (!result.found()) continue;
    ++found;
    ExpectSafe(config, world, now, result);
  }
  EXPECT_GE(found, 1);
}

TEST(ArmMotion, CouldDriveWhatIsFreeInItsMiddleAndInReachAtItsEnds) {
  const MotionPlanner planner(MakeKr16Run());
  const ScanPath path = MakePathAbout(3.0);
  const BoxWorld nothing;
  EXPECT_TRUE(planner.CouldDrive(nothing, path));
  BoxWorld world;
  const auto block = [&](const Eigen::Vector3d& p_W) {
    world.unknown = {MakeBox(p_W - Eigen::Vector3d::Constant(0.01), p_W + Eigen::Vector3d::Constant(0.01))};
  };
  block(path.X_WS_end.translation() + 0.1 * Eigen::Vector3d::UnitZ());
  EXPECT_EQ(planner.CheckPath(world, path).verdict, Verdict::kPartly);
  EXPECT_TRUE(planner.CouldDrive(world, path)) << "a part of it is left";
  block(0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation()));
  EXPECT_FALSE(planner.CouldDrive(world, path));
  ScanPath too_long = path;
  too_long.X_WS_end.translation().z() += 3.0;
  too_long.X_WS_start.translation().z() -= 3.0;
  EXPECT_FALSE(planner.CouldDrive(nothing, too_long));
}

TEST(ArmMotion, FirstPathOfTheCellCanBeDriven) {
  const RunConfig config = MakeKr16Run();
  BoxWorld world;
  world.unknown.push_back({config.grid.origin_W, config.grid.origin_W + 0.005 * config.grid.size.cast<double>()});
  EXPECT_NO_THROW(MotionPlanner(config).CheckStart(world, config.first_path));
}

/// The sentence that a cell is refused with.
std::string FindFault(const RunConfig& config, const BoxWorld& world = {}) {
  try {
    MotionPlanner(config).CheckStart(world, config.first_path);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ArmMotion, ArmThatStartsInCollisionIsRefused) {
  RunConfig config = MakeKr16Run();
  config.cell.arm->start_rad = {0, -0.5, 2.68, 0, 2.2, 0};
  EXPECT_EQ(FindFault(config), "In the cell kr16, the arm starts in collision with itself, the table or the floor.");
  config.cell.arm->start_rad = {0, -1.9, 1.9, 0, 7.0, 0};
  EXPECT_EQ(FindFault(config), "In the cell kr16, the arm starts beyond the limits of its joints.");
}

TEST(ArmMotion, FirstPathOutOfReachOrInCollisionIsRefused) {
  RunConfig config = MakeKr16Run();
  for (Pose* X : {&config.first_path.X_WS_start, &config.first_path.X_WS_end}) X->translation().x() += 5.0;
  EXPECT_EQ(FindFault(config),
            "In the cell kr16, the first scan path cannot be driven, it is out of the arm's reach: move the arm's base "
            "(X_OB) or the path (first_view_W, first_standoff_m).");
  config = MakeKr16Run();
  BoxWorld world;
  config.first_path = MakePathAbout(1.6);
  const Eigen::Vector3d p_W = config.first_path.X_WS_start.translation();
  world.unknown.push_back(MakeBox(p_W - Eigen::Vector3d(0.02, 0.02, 0.1), p_W + Eigen::Vector3d(0.02, 0.02, 0.3)));
  EXPECT_THAT(FindFault(config, world),
              HasSubstr("the first scan path cannot be driven, it comes too near to the box that is unknown"));
}

TEST(ArmMotion, FirstPathOfWhichTheArmCanDriveTheLesserPartIsRefused) {
  RunConfig config = MakeKr16Run();
  BoxWorld world;
  config.first_path = MakePathAbout(1.6);
  const Eigen::Vector3d end_W = config.first_path.X_WS_end.translation();
  const auto block_above = [&](double room_m) {
    const Eigen::Vector3d p_W = end_W + room_m * Eigen::Vector3d::UnitZ();
    world.unknown = {MakeBox(p_W - Eigen::Vector3d(0.3, 0.02, 0.0), p_W + Eigen::Vector3d(0.3, 0.02, 0.1))};
  };
  block_above(0.0);
  EXPECT_THAT(FindFault(config, world), HasSubstr("m of the first scan path of 0.20 m can be driven: move the arm's"));
  block_above(0.12);
  EXPECT_EQ(FindFault(config, world), "no error");
}

TEST(ArmMotion, ArmThatDoesNotFitTheCellIsRefused) {
  RunConfig config = MakeKr16Run();
  config.cell.arm->urdf = std::filesystem::path(NBS_SOURCE_DIR) / "tests/common/kinematics/ur5.urdf";
  config.cell.arm->base_link = "base";
  EXPECT_THAT(FindFault(config), HasSubstr("the arm has no spherical wrist"));
  config = MakeKr16Run();
  config.cell.arm->start_rad.pop_back();
  EXPECT_THAT(FindFault(config), HasSubstr("gives 5 joint values, but"));
}

TEST(ArmMotion, AnotherArmPlansFromItsOwnUrdf) {
  const RunConfig config = MakeSmallArmRun();
  BoxWorld world;
  world.occupied.push_back(MakeBox({-0.05, -0.05, 0.0}, {0.05, 0.05, 0.2}));
  const MotionPlanner planner(config);
  const RobotPosture now = planner.MakeStartPosture(config.first_path);
  ScanPath path = MakePathAbout(3.1416, 0.2, 0.2);
  path.X_WS_end.translation().z() -= 0.1;
  const MotionResult result = planner.Plan(world, now, path, 7);
  ASSERT_TRUE(result.found()) << ToString(result.verdict);
  ExpectSafe(config, world, now, result);
}

TEST(ArmMotion, ArmWithinItsMarginBacksOffFirst) {
  const RunConfig config = MakeKr16Run();
  const MotionPlanner planner(config);
  const RobotPosture start = planner.MakeStartPosture(config.first_path);
  const MotionResult one = planner.Plan(MakeObjectWorld(), start, MakePathAbout(3.0), 7);
  ASSERT_TRUE(one.found());
  const TrajectoryPoint& last = one.trajectory.points.back();
  const RobotPosture now{last.X_WF * config.cell.X_FS, last.joints_rad};
  BoxWorld world = MakeObjectWorld();
  // Something unknown has come up 70 mm in front of the sensor's housing.
  const Eigen::Vector3d p_W = now.X_WS * Eigen::Vector3d(0, 0.06, 0.012);
  world.unknown.push_back({p_W - Eigen::Vector3d::Constant(0.002), p_W + Eigen::Vector3d::Constant(0.002)});
  ASSERT_FALSE(
      ArmCollision(config, ReadKr16()).IsFree(world, Eigen::Map<const Eigen::VectorXd>(now.joints_rad.data(), 6)));
  const MotionResult result = planner.Plan(world, now, MakePathAbout(3.0, 0.47), 7);
  ASSERT_TRUE(result.found()) << ToString(result.verdict);
  EXPECT_EQ(FindArmRefusal(result.trajectory, Eigen::Map<const Eigen::VectorXd>(now.joints_rad.data(), 6),
                           MakeArmLimits(config)),
            "");
}

}  // namespace
}  // namespace nbs
