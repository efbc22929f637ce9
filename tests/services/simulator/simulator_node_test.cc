#include "services/simulator/simulator_node.h"

#include <gtest/gtest.h>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

RobotState MakeScanningState(int64_t utime_us, int32_t scan) {
  RobotState state;
  state.utime_us = utime_us;
  state.scan = scan;
  state.scanning = true;
  state.X_WF = MakeLookPose({0.0, 0.0, 0.4}, -Vector3d::UnitZ(), Vector3d::UnitY());
  return state;
}

std::vector<Profile> Feed(SimulatorNode& node, const std::vector<RobotState>& states) {
  Outbox out;
  node.Start(out);
  for (const RobotState& state : states) {
    EXPECT_EQ(node.NextInput(), StreamOf<RobotState>());
    node.Handle(state, out);
  }
  std::vector<Profile> profiles;
  for (const Message& message : out) profiles.push_back(std::get<Profile>(message));
  return profiles;
}

RunConfig MakeNoiselessConfig() {
  RunConfig config;
  config.cell.profiler.sigma_base_m = 0.0;
  config.cell.profiler.sigma_per_m = 0.0;
  return config;
}

TEST(SimulatorNode, OnlyScanningStatesGiveAProfileAtTheirTime) {
  SimulatorNode node(MakeSphere(0.1f, 4), RunConfig());
  RobotState moving = MakeScanningState(40000, 0);
  moving.scanning = false;
  const auto profiles = Feed(node, {moving, MakeScanningState(80000, 0), MakeScanningState(120000, 0)});
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_EQ(profiles[0].utime_us, 80000);
  EXPECT_EQ(profiles[1].utime_us, 120000);
  EXPECT_EQ(profiles[0].ranges_m.size(), 224u);
  EXPECT_FALSE(profiles[0].end_of_scan);
}

TEST(SimulatorNode, EndOfScanGivesAClosingProfileWithoutRanges) {
  SimulatorNode node(MakeSphere(0.1f, 4), RunConfig());
  RobotState end = MakeScanningState(80000, 0);
  end.scanning = false;
  end.end_of_scan = true;
  const auto profiles = Feed(node, {MakeScanningState(40000, 0), end});
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_TRUE(profiles[1].end_of_scan);
  EXPECT_TRUE(profiles[1].ranges_m.empty());
  EXPECT_EQ(profiles[1].utime_us, 80000);
}

TEST(SimulatorNode, NoiseDependsOnScanAndProfileNumberAlone) {
  const TriangleMesh sphere = MakeSphere(0.1f, 4);
  SimulatorNode first(sphere, RunConfig());
  SimulatorNode second(sphere, RunConfig());
  const auto a = Feed(first, {MakeScanningState(0, 0), MakeScanningState(40000, 0), MakeScanningState(80000, 1)});
  const auto b = Feed(second, {MakeScanningState(500000, 1), MakeScanningState(540000, 2)});
  EXPECT_EQ(a[2].ranges_m, b[0].ranges_m);
  EXPECT_NE(a[0].ranges_m, a[1].ranges_m);
  EXPECT_NE(a[0].ranges_m, b[1].ranges_m);
}

TEST(SimulatorNode, HandEyeTransformPlacesTheSensorOnTheFlange) {
  RunConfig config = MakeNoiselessConfig();
  config.cell.X_FS.translation() = Vector3d(0.0, 0.0, 0.05);
  SimulatorNode node(MakeSquare(1.0f, 0.0f), config);
  const auto profiles = Feed(node, {MakeScanningState(0, 0)});
  EXPECT_NEAR(profiles[0].ranges_m[0], 0.35 / std::cos(0.5 * config.cell.profiler.fan_rad), 1e-6);
}

TEST(SimulatorNode, ProfileIsTakenWhereTheArmTrulyIs) {
  RunConfig config = MakeNoiselessConfig();
  SimulatorNode exact(MakeSquare(1.0f, 0.0f), config);
  config.cell.arm.emplace().pose_bias_m = 0.01;
  SimulatorNode biased(MakeSquare(1.0f, 0.0f), config);
  const RobotState state = MakeScanningState(0, 0);
  const double off_m = PoseError::Make(config).CalcBias(state.X_WF).z();
  ASSERT_GT(std::abs(off_m), 1e-4);
  const double cosine = std::cos(0.5 * config.cell.profiler.fan_rad / 223.0);
  EXPECT_NEAR(cosine * (Feed(biased, {state})[0].ranges_m[112] - Feed(exact, {state})[0].ranges_m[112]), off_m, 1e-6);
}

TEST(SimulatorNode, TableBlocksAndGivesNoReturn) {
  RunConfig config = MakeNoiselessConfig();
  SimulatorNode without(MakeSquare(0.02f, 0.0f), config);
  config.cell.table_z_m = 0.1;
  SimulatorNode with(MakeSquare(0.02f, 0.0f), config);
  const std::vector<RobotState> states = {MakeScanningState(0, 0)};
  EXPECT_GT(Feed(without, states)[0].ranges_m[112], 0.39f);
  EXPECT_EQ(Feed(with, states)[0].ranges_m, std::vector<float>(224, 0.0f));
  config.cell.table_half_m = {0.05, 0.05};
  config.p_WO = {1.0, 0.0, 0.0};
  SimulatorNode beside(MakeSquare(0.02f, 0.0f), config);
  EXPECT_GT(Feed(beside, states)[0].ranges_m[112], 0.39f);
}

}  // namespace
}  // namespace nbs
