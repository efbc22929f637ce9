#include "services/robot/robot_node.h"

#include <gtest/gtest.h>

#include "common/runtime/error.h"

namespace nbs {
namespace {

Pose At(double x_m) { return MakePose({x_m, 0, 0}, Eigen::Quaterniond::Identity()); }

// Two periods of the profile clock at 0.05 m/s, all of it scanning.
Trajectory MakeScan(int64_t utime_us, int scan, double x_m) {
  return {utime_us, scan, {{0, At(x_m), {}, true}, {80'000, At(x_m + 0.004), {}, false}}};
}

struct Answer {
  std::vector<RobotState> states;
  Execution execution;
};

Answer Execute(RobotNode& node, const Trajectory& trajectory) {
  Outbox out;
  node.Handle(trajectory, out);
  Answer answer;
  for (size_t i = 0; i + 1 < out.size(); ++i) answer.states.push_back(std::get<RobotState>(out[i]));
  answer.execution = std::get<Execution>(out.back());
  return answer;
}

TEST(RobotNode, PublishesStatesThenTheEndOfTheScanThenTheExecution) {
  RobotNode node{RunConfig{}};
  const Answer answer = Execute(node, MakeScan(1, 0, 0.5));
  ASSERT_EQ(answer.states.size(), 4u);
  EXPECT_EQ(answer.states[0].utime_us, 40'000);
  EXPECT_EQ(answer.states[0].X_WF.matrix(), At(0.5).matrix());
  EXPECT_TRUE(answer.states[0].scanning && answer.states[1].scanning && answer.states[2].scanning);
  EXPECT_TRUE(answer.states[3].end_of_scan);
  EXPECT_FALSE(answer.states[3].scanning);
  EXPECT_EQ(answer.states[3].utime_us, 160'000);
  EXPECT_TRUE(answer.execution.done);
  EXPECT_EQ(answer.execution.refusal, "");
  EXPECT_EQ(answer.execution.utime_us, 160'000);
}

TEST(RobotNode, TimesRiseOverScans) {
  RobotNode node{RunConfig{}};
  const Answer first = Execute(node, MakeScan(0, 0, 0.5));
  const Answer second = Execute(node, MakeScan(first.execution.utime_us, 1, 0.504));
  EXPECT_GT(second.states.front().utime_us, first.states.back().utime_us);
  EXPECT_EQ(second.states.front().scan, 1);
}

TEST(RobotNode, ATrajectoryThatStartsElsewhereIsRefusedAndTheScanIsClosed) {
  RobotNode node{RunConfig{}};
  const Answer first = Execute(node, MakeScan(0, 0, 0.5));
  const Answer second = Execute(node, MakeScan(first.execution.utime_us, 1, 0.5));
  ASSERT_EQ(second.states.size(), 1u);
  EXPECT_TRUE(second.states[0].end_of_scan);
  EXPECT_EQ(second.states[0].X_WF.matrix(), At(0.504).matrix());
  EXPECT_EQ(second.states[0].scan, 1);
  EXPECT_FALSE(second.execution.done);
  EXPECT_NE(second.execution.refusal, "");
  EXPECT_EQ(node.Complaints().front().count, 1);
}

TEST(RobotNode, StaysWhereItIsAfterARefusal) {
  RobotNode node{RunConfig{}};
  (void)Execute(node, MakeScan(0, 0, 0.5));
  (void)Execute(node, MakeScan(0, 1, 0.9));
  EXPECT_TRUE(Execute(node, MakeScan(0, 2, 0.504)).execution.done);
}

TEST(RobotNode, AnEmptyFirstTrajectoryIsRefusedAndTheScanIsClosed) {
  RobotNode node{RunConfig{}};
  const Answer answer = Execute(node, {0, 0, {}});
  ASSERT_EQ(answer.states.size(), 1u);
  EXPECT_TRUE(answer.states[0].end_of_scan);
  EXPECT_FALSE(answer.execution.done);
}

TEST(RobotNode, EqualTrajectoriesGiveEqualStates) {
  RobotNode one{RunConfig{}};
  RobotNode two{RunConfig{}};
  const Answer a = Execute(one, MakeScan(17, 0, 0.5));
  const Answer b = Execute(two, MakeScan(17, 0, 0.5));
  ASSERT_EQ(a.states.size(), b.states.size());
  for (size_t i = 0; i < a.states.size(); ++i) EXPECT_EQ(a.states[i].X_WF.matrix(), b.states[i].X_WF.matrix());
}

TEST(RobotNode, AnArmWithoutItsUrdfIsAConfigurationError) {
  RunConfig config;
  config.cell.robot = "arm";
  config.cell.arm.emplace().urdf = "/nowhere/arm.urdf";
  EXPECT_THROW(RobotNode{config}, ConfigError);
}

}  // namespace
}  // namespace nbs
