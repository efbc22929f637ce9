#include "services/reporter/run_traces.h"

#include <gtest/gtest.h>

#include "services/reporter/run_record.h"

namespace nbs {
namespace {

RobotState MakeState(int64_t utime_us, int32_t scan) { return {utime_us, scan, false, false, Pose::Identity(), {}}; }

TEST(GroupMotions, PutsStatesTrajectoryAndExecutionOfAScanTogether) {
  const std::vector<Trajectory> trajectories = {{10, 0, {}}, {50, 1, {}}};
  const std::vector<RobotState> states = {MakeState(10, 0), MakeState(20, 0), MakeState(50, 1)};
  const auto [motions, refused_states] =
      GroupMotions(trajectories, states, {{30, 0, true, ""}, {60, 1, false, "too fast"}}, std::nullopt);
  ASSERT_EQ(motions.size(), 2u);
  EXPECT_EQ(motions[0].states.size(), 2u);
  EXPECT_EQ(motions[0].trajectory.utime_us, 10);
  EXPECT_TRUE(motions[0].done);
  EXPECT_EQ(motions[1].trajectory.scan, 1);
  EXPECT_FALSE(motions[1].done);
  EXPECT_EQ(refused_states, 0);
}

TEST(GroupMotions, WhatWasNeverExecutedIsNoMotion) {
  EXPECT_TRUE(GroupMotions({{10, 0, {}}}, {}, {}, std::nullopt).motions.empty());
}

RobotState WithJoints(RobotState state, size_t joints) {
  state.joints_rad.assign(joints, 0.1);
  return state;
}

TEST(GroupMotions, OfAnArmOnlyStatesWithAllItsJointsAreTakenAndTheOthersCounted) {
  const std::vector<RobotState> states = {WithJoints(MakeState(10, 0), 6), MakeState(20, 0),
                                          WithJoints(MakeState(50, 1), 7), WithJoints(MakeState(80, 2), 6)};
  const std::vector<Execution> executions = {{30, 0, true, ""}, {60, 1, true, ""}, {90, 2, true, ""}};
  const auto [motions, refused_states] = GroupMotions({}, states, executions, 6);
  EXPECT_EQ(refused_states, 2);
  ASSERT_EQ(motions.size(), 2u);
  ASSERT_EQ(motions[0].states.size(), 1u);
  EXPECT_EQ(motions[0].states[0].utime_us, 10);
  EXPECT_FALSE(motions[0].done) << "its states alone count";
  EXPECT_TRUE(motions[1].done);
}

TEST(GroupMotions, TrajectoryWithoutTheArmsJointsDoesNotCount) {
  const Trajectory flange_only{10, 0, {{0, Pose::Identity(), {}, false}}};
  const auto motions = GroupMotions({flange_only}, {WithJoints(MakeState(10, 0), 6)}, {{30, 0, true, ""}}, 6).motions;
  ASSERT_EQ(motions.size(), 1u);
  EXPECT_FALSE(motions[0].done);
}

TEST(GroupMotions, FreeFlyingSensorMayReportJoints) {
  EXPECT_EQ(GroupMotions({}, {WithJoints(MakeState(10, 0), 3)}, {}, std::nullopt).refused_states, 0);
}

TEST(AddPlanning, CountsTheRoundsAfterTheLastScanToo) {
  RunRecord record;
  record.scans.resize(2);
  record.scans[1].timing = {0, 1, 1.0, 2.0, 3.0, 10.0, 16.0, {}};
  record.last_timing = {0, 2, 0.5, 0.0, 0.0, 1.0, 1.5, {}};
  TimeSplit split;
  AddPlanning(record, split);
  EXPECT_DOUBLE_EQ(split.selection_s, 6.5);
  EXPECT_DOUBLE_EQ(split.planning_s, 11.0);
}

}  // namespace
}  // namespace nbs
