#include "services/robot/arm_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/robot/robot_node.h"

namespace nbs {
namespace {

using testing::HasSubstr;

RunConfig MakeKr16Run() {
  RunConfig config;
  config.cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/kr16.yaml");
  ResolvePlacement({Eigen::Vector3d(-0.1, -0.1, 0.0), Eigen::Vector3d(0.1, 0.1, 0.5)}, config);
  return config;
}

class ArmCheck : public testing::Test {
 protected:
  /// A1 turns by 0.2 rad and comes to rest: speeds up for 0.2 s, turns for 0.2 s, slows down for 0.2 s.
  ArmCheck() {
    const double turned[] = {0.0, 0.0125, 0.05, 0.15, 0.1875, 0.2};
    const int64_t times_us[] = {0, 100000, 200000, 400000, 500000, 600000};
    for (int i = 0; i < 6; ++i) {
      Joints q = q_now_;
      q[0] += turned[i];
      trajectory_.points.push_back({times_us[i], PoseOf(q), {q.begin(), q.end()}, false});
    }
  }

  Pose PoseOf(const Joints& q) const { return limits_.X_WB * CalcFlangePose(limits_.model, q); }
  void MoveJoint(size_t point, size_t joint, double q) {
    TrajectoryPoint& at = trajectory_.points[point];
    at.joints_rad[joint] = q;
    at.X_WF = PoseOf(Eigen::Map<const Eigen::VectorXd>(at.joints_rad.data(), 6));
  }
  std::string Refuse() const { return FindArmRefusal(trajectory_, q_now_, limits_); }

  RunConfig config_ = MakeKr16Run();
  ArmLimits limits_ = MakeArmLimits(config_);
  Joints q_now_ = Eigen::Map<const Eigen::VectorXd>(config_.cell.arm->start_rad.data(), 6);
  Trajectory trajectory_;
};

TEST_F(ArmCheck, MotionWithinAllLimitsIsTaken) { EXPECT_EQ(Refuse(), ""); }

TEST_F(ArmCheck, StartElsewhereIsRefused) {
  q_now_[2] += 0.01;
  EXPECT_EQ(Refuse(), "The trajectory starts with joint_a3 0.0100 rad away from where the arm is.");
}

TEST_F(ArmCheck, JointBeyondItsLimitIsRefused) {
  MoveJoint(5, 4, 2.3);
  EXPECT_THAT(Refuse(), HasSubstr("Point 5 has joint_a5 at 2.3000 rad; its limits are -2.2689 and 2.2689 rad."));
}

TEST_F(ArmCheck, JointThatTurnsTooFastIsRefused) {
  MoveJoint(2, 3, 0.8);
  EXPECT_THAT(Refuse(), HasSubstr("joint_a4 turns at"));
}

TEST_F(ArmCheck, JointThatJerksIsRefused) {
  MoveJoint(5, 1, q_now_[1] + 0.06);
  EXPECT_THAT(Refuse(), HasSubstr("joint_a2 changes its speed by"));
}

TEST_F(ArmCheck, PoseThatIsNotThatOfItsJointsIsRefused) {
  trajectory_.points[3].X_WF.translation().z() += 0.002;
  EXPECT_EQ(Refuse(), "The pose of point 3 is not that of its joints: the flange is 0.0020 m off.");
}

TEST_F(ArmCheck, MissingJointsAreRefused) {
  trajectory_.points[1].joints_rad.pop_back();
  EXPECT_EQ(Refuse(), "Point 1 has 5 joint values, but the arm has 6 joints.");
}

TEST_F(ArmCheck, SensorThatScansTooFastIsRefused) {
  trajectory_.points[2].scanning = true;
  EXPECT_THAT(Refuse(), HasSubstr("Between points 2 and 3 it scans at"));
}

TEST_F(ArmCheck, RobotReportsJointsAndTheFlangeThatBelongsToThem) {
  RobotNode robot(config_);
  Outbox out;
  trajectory_.points[4].scanning = true;
  trajectory_.points[5].time_us = 2000000;
  robot.Handle(trajectory_, out);
  EXPECT_TRUE(std::get<Execution>(out.back()).done) << std::get<Execution>(out.back()).refusal;
  ASSERT_EQ(out.size(), 53u);
  for (size_t i = 0; i + 1 < out.size(); ++i) {
    const auto& state = std::get<RobotState>(out[i]);
    ASSERT_EQ(state.joints_rad.size(), 6u);
    EXPECT_EQ(state.X_WF.matrix(), PoseOf(Eigen::Map<const Eigen::VectorXd>(state.joints_rad.data(), 6)).matrix());
  }
  EXPECT_NEAR(std::get<RobotState>(out[8]).joints_rad[0] - q_now_[0], 0.11, 1e-9);
}

TEST_F(ArmCheck, RobotRestsWhereTheCellSaysAndRefusesAnotherStart) {
  RobotNode robot(config_);
  for (size_t point = 0; point < 6; ++point) MoveJoint(point, 1, q_now_[1] + 0.1);
  Outbox out;
  robot.Handle(trajectory_, out);
  EXPECT_FALSE(std::get<Execution>(out.back()).done);
  const auto& state = std::get<RobotState>(out.front());
  EXPECT_TRUE(state.end_of_scan);
  EXPECT_EQ(state.joints_rad, config_.cell.arm->start_rad);
}

}  // namespace
}  // namespace nbs
