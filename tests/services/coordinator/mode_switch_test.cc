#include <gtest/gtest.h>

#include <vector>

#include "services/coordinator/run_logic.h"

namespace nbs {
namespace {

struct MeshFigures {
  double completeness;
  int64_t edges;
};

// The number of scans after which the run turns to holes, given the mesh after each scan; 0: never.
int CountScansBeforeHoles(const std::vector<MeshFigures>& meshes) {
  const RunSettings settings;
  RunLogicState state = Begin(settings).state;
  for (const MeshFigures& figures : meshes) {
    Plan plan;
    plan.scan = state.scan;
    plan.mode = state.mode;
    plan.found = true;
    state = Advance(settings, state, plan).state;
    state = Advance(settings, state, Execution{0, state.scan, true, ""}).state;
    MeshScan mesh;
    mesh.scan = state.scan;
    mesh.completeness = figures.completeness;
    mesh.edges = figures.edges;
    state = Advance(settings, state, mesh).state;
    if (state.mode == PlanMode::kHole) return state.scan;
  }
  return 0;
}

TEST(ModeSwitch, ComesAfterTwoBoundaryScansThatHardlyChangedTheMesh) {
  EXPECT_EQ(
      CountScansBeforeHoles(
          {{0.975, 30'000}, {0.978, 50'000}, {0.983, 70'000}, {0.986, 80'000}, {0.9865, 81'000}, {0.9867, 82'000}}),
      6);
}

TEST(ModeSwitch, DoesNotComeAfterOneSuchScan) {
  EXPECT_EQ(
      CountScansBeforeHoles({{0.975, 30'000}, {0.975, 30'500}, {0.979, 31'000}, {0.979, 31'500}, {0.983, 32'000}}), 0);
}

TEST(ModeSwitch, DoesNotComeWhileTheSurfaceGrowsThoughCompletenessStandsStill) {
  EXPECT_EQ(
      CountScansBeforeHoles({{0.975, 30'000}, {0.974, 48'000}, {0.9745, 66'000}, {0.9745, 80'000}, {0.975, 90'000}}),
      0);
}

TEST(ModeSwitch, DoesNotComeWhileBordersCloseThoughTheSurfaceHardlyGrows) {
  EXPECT_EQ(
      CountScansBeforeHoles({{0.950, 80'000}, {0.957, 81'000}, {0.964, 82'000}, {0.969, 83'000}, {0.974, 84'000}}), 0);
}

TEST(ModeSwitch, ComesWhenCompletenessFallsWithoutNewSurface) {
  EXPECT_EQ(CountScansBeforeHoles({{0.980, 80'000}, {0.979, 80'500}, {0.978, 81'000}}), 3);
}

TEST(ModeSwitch, TheFirstScanCountsAsAChange) { EXPECT_EQ(CountScansBeforeHoles({{0.0, 0}, {0.0, 0}}), 0); }

TEST(ModeSwitch, AChangeOfExactlyTheLimitIsNotHardlyAny) {
  const RunSettings settings;
  MeshScan before;
  before.completeness = 0.5;
  before.edges = 1000;
  MeshScan after = before;
  after.completeness = 0.5 + settings.settled_closing * 0.5;
  EXPECT_FALSE(HasHardlyChanged(settings, before, after));
  after.completeness = 0.5;
  after.edges = 1050;
  EXPECT_FALSE(HasHardlyChanged(settings, before, after));
  after.edges = 1049;
  EXPECT_TRUE(HasHardlyChanged(settings, before, after));
}

}  // namespace
}  // namespace nbs
