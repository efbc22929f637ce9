#include "services/coordinator/run_logic.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "common/runtime/error.h"

namespace nbs {
namespace {

const RunSettings kSettings;

template <typename T>
const T& Find(const RunStep& step) {
  for (const Message& message : step.commands) {
    if (const T* found = std::get_if<T>(&message)) return *found;
  }
  throw std::runtime_error("no such command");
}

Plan MakePlan(int scan, PlanMode mode, bool found, std::string reason = {}) {
  Plan plan;
  plan.utime_us = 100;
  plan.scan = scan;
  plan.mode = mode;
  plan.found = found;
  plan.reason = std::move(reason);
  if (found) plan.trajectory = {0, scan, {{0, Pose::Identity(), {}, true}}};
  return plan;
}

/// Nothing is left; the words say something else, since they decide nothing.
Plan MakeEmptyPlan(int scan, PlanMode mode) {
  Plan plan = MakePlan(scan, mode, false, "In other words.");
  plan.stack_is_empty = true;
  return plan;
}

MeshScan MakeMesh(int scan, double completeness, int64_t edges = 10'000) {
  MeshScan mesh;
  mesh.utime_us = 900;
  mesh.scan = scan;
  mesh.completeness = completeness;
  mesh.edges = edges;
  return mesh;
}

// A state that awaits `awaiting` of scan `scan`.
RunLogicState MakeState(Awaiting awaiting, int scan, PlanMode mode) {
  RunLogicState state;
  state.awaiting = awaiting;
  state.scan = scan;
  state.mode = mode;
  state.utime_us = 50;
  return state;
}

TEST(RunLogic, BeginsByAskingForTheFirstScanPath) {
  const RunStep step = Begin(kSettings);
  EXPECT_EQ(step.state.awaiting, Awaiting::kPlan);
  EXPECT_EQ(Find<PlanRequest>(step).scan, 0);
  EXPECT_EQ(Find<PlanRequest>(step).mode, PlanMode::kFirst);
  EXPECT_EQ(Find<RunState>(step).phase, RunPhase::kPlanning);
}

TEST(RunLogic, AFoundPlanSendsItsTrajectoryAfterTheLatestTime) {
  const RunStep step =
      Advance(kSettings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), MakePlan(3, PlanMode::kBoundary, true));
  EXPECT_EQ(step.state.awaiting, Awaiting::kExecution);
  EXPECT_EQ(Find<Trajectory>(step).utime_us, 101);
  EXPECT_EQ(Find<Trajectory>(step).scan, 3);
  EXPECT_EQ(Find<Trajectory>(step).points.size(), 1u);
  EXPECT_EQ(Find<RunState>(step).phase, RunPhase::kScanning);
}

TEST(RunLogic, NoBoundaryLeftAsksForTheSameScanAmongHoles) {
  const RunStep step =
      Advance(kSettings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), MakePlan(3, PlanMode::kBoundary, false));
  EXPECT_EQ(step.state.awaiting, Awaiting::kPlan);
  EXPECT_EQ(Find<PlanRequest>(step).scan, 3);
  EXPECT_EQ(Find<PlanRequest>(step).mode, PlanMode::kHole);
}

TEST(RunLogic, NoBoundaryLeftEndsAMethodWithoutHoles) {
  RunSettings settings;
  settings.search = CandidateSearch::kBoundary;
  const RunStep step =
      Advance(settings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), MakeEmptyPlan(3, PlanMode::kBoundary));
  EXPECT_EQ(step.state.awaiting, Awaiting::kNothing);
  EXPECT_EQ(Find<RunState>(step).end_reason, "no_candidates");
  EXPECT_FALSE(Find<RunState>(step).failed);
}

TEST(RunLogic, NothingLeftOfACompleteMeshMeansThatItIsComplete) {
  RunLogicState state = MakeState(Awaiting::kPlan, 7, PlanMode::kHole);
  state.last_scan = MakeMesh(6, 0.99);
  const Plan plan = MakeEmptyPlan(7, PlanMode::kHole);
  EXPECT_EQ(Find<RunState>(Advance(kSettings, state, plan)).end_reason, "completeness_reached");
  state.last_scan = MakeMesh(6, 0.98);
  EXPECT_EQ(Find<RunState>(Advance(kSettings, state, plan)).end_reason, "no_candidates");
}

TEST(RunLogic, NoHoleReachableEndsTheRunWithThePlannersReason) {
  const RunStep step = Advance(kSettings, MakeState(Awaiting::kPlan, 7, PlanMode::kHole),
                               MakePlan(7, PlanMode::kHole, false, "All blocked."));
  EXPECT_EQ(step.state.awaiting, Awaiting::kNothing);
  EXPECT_EQ(Find<RunState>(step).phase, RunPhase::kFinished);
  EXPECT_EQ(Find<RunState>(step).scan, 7);
  EXPECT_EQ(Find<RunState>(step).end_reason, "nothing_reachable");
  EXPECT_EQ(Find<RunState>(step).detail, "All blocked.");
  EXPECT_FALSE(Find<RunState>(step).failed);
}

TEST(RunLogic, ThePlannersWordsDecideNothing) {
  const Plan plan = MakePlan(7, PlanMode::kHole, false, "Blocked, but not that the stack is empty.");
  const RunStep step = Advance(kSettings, MakeState(Awaiting::kPlan, 7, PlanMode::kHole), plan);
  EXPECT_EQ(Find<RunState>(step).end_reason, "nothing_reachable");
}

TEST(RunLogic, AFirstPathThatCannotBeReachedFailsTheRun) {
  const RunStep step = Advance(kSettings, Begin(kSettings).state, MakePlan(0, PlanMode::kFirst, false, "Blocked."));
  EXPECT_TRUE(Find<RunState>(step).failed);
  EXPECT_EQ(Find<RunState>(step).end_reason, "nothing_reachable");
  EXPECT_EQ(Find<RunState>(step).scan, 0);
}

TEST(RunLogic, ARunThatHasSeenNothingFails) {
  RunLogicState state = MakeState(Awaiting::kPlan, 1, PlanMode::kHole);
  state.last_scan = MeshScan{};
  const Plan plan = MakeEmptyPlan(1, PlanMode::kHole);
  EXPECT_TRUE(Find<RunState>(Advance(kSettings, state, plan)).failed);
  state.last_scan->edges = 3;
  EXPECT_FALSE(Find<RunState>(Advance(kSettings, state, plan)).failed);
}

TEST(RunLogic, AnExecutedTrajectoryAwaitsTheMesh) {
  const RunStep step =
      Advance(kSettings, MakeState(Awaiting::kExecution, 3, PlanMode::kBoundary), Execution{800, 3, true, ""});
  EXPECT_EQ(step.state.awaiting, Awaiting::kMeshScan);
  EXPECT_EQ(step.state.utime_us, 800);
  EXPECT_TRUE(step.commands.empty());
}

TEST(RunLogic, ARefusedTrajectoryFailsTheRun) {
  const RunStep step = Advance(kSettings, MakeState(Awaiting::kExecution, 3, PlanMode::kBoundary),
                               Execution{800, 3, false, "Too fast."});
  EXPECT_EQ(step.state.awaiting, Awaiting::kNothing);
  EXPECT_TRUE(Find<RunState>(step).failed);
  EXPECT_EQ(Find<RunState>(step).end_reason, "refused");
  EXPECT_EQ(Find<RunState>(step).detail, "Too fast.");
  EXPECT_EQ(Find<RunState>(step).scan, 3);
}

TEST(RunLogic, ACompleteMeshEndsTheRun) {
  RunLogicState state = MakeState(Awaiting::kMeshScan, 2, PlanMode::kBoundary);
  state.last_scan = MakeMesh(1, 0.99, 9'900);
  // One scan that adds little may have been a poor one.
  state = Advance(kSettings, state, MakeMesh(2, 0.99, 9'950)).state;
  EXPECT_EQ(state.awaiting, Awaiting::kPlan);
  EXPECT_EQ(state.grown_out, 1);
  state.awaiting = Awaiting::kMeshScan;
  const RunStep step = Advance(kSettings, state, MakeMesh(3, 0.9875));
  EXPECT_EQ(step.state.awaiting, Awaiting::kNothing);
  EXPECT_EQ(Find<RunState>(step).end_reason, "completeness_reached");
  EXPECT_EQ(Find<RunState>(step).scan, 4);
  EXPECT_FALSE(Find<RunState>(step).failed);
}

TEST(RunLogic, AMeshThatStillGrowsIsNotComplete) {
  RunLogicState state = MakeState(Awaiting::kMeshScan, 3, PlanMode::kBoundary);
  state.last_scan = MakeMesh(2, 0.98, 9'500);
  state.grown_out = 5;
  const RunStep step = Advance(kSettings, state, MakeMesh(3, 0.9875));
  EXPECT_EQ(Find<PlanRequest>(step).scan, 4);
  EXPECT_EQ(step.state.grown_out, 0);
}

TEST(RunLogic, TheFirstScanAloneDoesNotCompleteTheMesh) {
  const RunStep step = Advance(kSettings, MakeState(Awaiting::kMeshScan, 0, PlanMode::kFirst), MakeMesh(0, 0.999));
  EXPECT_EQ(Find<PlanRequest>(step).scan, 1);
  EXPECT_EQ(Find<PlanRequest>(step).mode, PlanMode::kBoundary);
}

TEST(RunLogic, TheLimitOnScansEndsTheRun) {
  RunSettings settings;
  settings.max_scans = 4;
  const RunStep step = Advance(settings, MakeState(Awaiting::kMeshScan, 3, PlanMode::kBoundary), MakeMesh(3, 0.9));
  EXPECT_EQ(Find<RunState>(step).end_reason, "scan_limit");
  EXPECT_EQ(Find<RunState>(step).scan, 4);
}

TEST(RunLogic, ALimitOfOneScanEndsTheRunAfterTheFirst) {
  RunSettings settings;
  settings.max_scans = 1;
  const RunStep step = Advance(settings, MakeState(Awaiting::kMeshScan, 0, PlanMode::kFirst), MakeMesh(0, 0.999));
  EXPECT_EQ(Find<RunState>(step).end_reason, "scan_limit");
}

TEST(RunLogic, ASphereMethodStaysOnTheSphere) {
  RunSettings settings;
  settings.search = CandidateSearch::kSphere;
  const RunStep step = Advance(settings, MakeState(Awaiting::kMeshScan, 0, PlanMode::kFirst), MakeMesh(0, 0.9));
  EXPECT_EQ(Find<PlanRequest>(step).mode, PlanMode::kSphere);
}

TEST(RunLogic, AMethodThatScansAllItHasIgnoresTheCompleteness) {
  RunSettings settings;
  settings.end = EndRule::kNothingLeft;
  RunLogicState state = MakeState(Awaiting::kMeshScan, 3, PlanMode::kBoundary);
  state.last_scan = MakeMesh(2, 1.0, 9'999);
  state.grown_out = 5;
  EXPECT_EQ(Find<PlanRequest>(Advance(settings, state, MakeMesh(3, 1.0))).scan, 4);
}

TEST(RunLogic, UnknownVoxelsThatHardlyChangeEndAMethodThatCountsThem) {
  RunSettings settings;
  settings.search = CandidateSearch::kSphere;
  settings.end = EndRule::kUnknownSettled;
  RunLogicState state = MakeState(Awaiting::kPlan, 4, PlanMode::kSphere);
  state.unknown_cells = 100'000;
  state.unknown_at_start = 500'000;
  Plan plan = MakePlan(4, PlanMode::kSphere, true);
  plan.unknown_cells = 94'990;
  EXPECT_EQ(Advance(settings, state, plan).state.awaiting, Awaiting::kExecution);
  EXPECT_EQ(Advance(settings, state, plan).state.unknown_cells, 94'990);
  plan.unknown_cells = 95'001;
  EXPECT_EQ(Find<RunState>(Advance(settings, state, plan)).end_reason, "unknown_settled");
  settings.end = EndRule::kCompleteness;
  EXPECT_EQ(Advance(settings, state, plan).state.awaiting, Awaiting::kExecution);
}

TEST(RunLogic, TheFirstPlanTellsHowManyVoxelsAreUnknownAtTheStart) {
  Plan plan = MakePlan(0, PlanMode::kFirst, true);
  plan.unknown_cells = 700'000;
  EXPECT_EQ(Advance(kSettings, MakeState(Awaiting::kPlan, 0, PlanMode::kFirst), plan).state.unknown_at_start, 700'000);
  plan = MakePlan(1, PlanMode::kSphere, true);
  plan.unknown_cells = 600'000;
  RunLogicState state = MakeState(Awaiting::kPlan, 1, PlanMode::kSphere);
  state.unknown_at_start = 700'000;
  EXPECT_EQ(Advance(kSettings, state, plan).state.unknown_at_start, 700'000);
}

TEST(RunLogic, HolesAreScannedForTheRestOfTheRun) {
  const RunStep step = Advance(kSettings, MakeState(Awaiting::kMeshScan, 8, PlanMode::kHole), MakeMesh(8, 0.95));
  EXPECT_EQ(Find<PlanRequest>(step).scan, 9);
  EXPECT_EQ(Find<PlanRequest>(step).mode, PlanMode::kHole);
}

TEST(RunLogic, TheNextRequestIsLaterThanTheMesh) {
  const RunStep step = Advance(kSettings, MakeState(Awaiting::kMeshScan, 3, PlanMode::kBoundary), MakeMesh(3, 0.9));
  EXPECT_EQ(Find<PlanRequest>(step).utime_us, 901);
  EXPECT_EQ(Find<RunState>(step).utime_us, 901);
}

TEST(RunLogic, WhatIsNotAwaitedThrows) {
  EXPECT_THROW(Advance(kSettings, MakeState(Awaiting::kMeshScan, 3, PlanMode::kBoundary),
                       MakePlan(3, PlanMode::kBoundary, true)),
               std::logic_error);
  EXPECT_THROW(
      Advance(kSettings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), MakePlan(2, PlanMode::kBoundary, true)),
      std::logic_error);
  EXPECT_THROW(
      Advance(kSettings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), MakePlan(3, PlanMode::kHole, true)),
      std::logic_error);
  EXPECT_THROW(Advance(kSettings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), Execution{}), std::logic_error);
  EXPECT_THROW(Advance(kSettings, MakeState(Awaiting::kPlan, 3, PlanMode::kBoundary), MeshScan{}), std::logic_error);
}

TEST(RunSettings, ComeFromTheRunsConfiguration) {
  RunConfig config;
  config.completeness = 0.9;
  config.max_scans = 12;
  config.method = "B/IG";
  const RunSettings settings = MakeRunSettings(config);
  EXPECT_EQ(settings.completeness, 0.9);
  EXPECT_EQ(settings.max_scans, 12);
  EXPECT_EQ(settings.search, CandidateSearch::kBoundary);
  config.method = "BH/IG";
  EXPECT_EQ(MakeRunSettings(config).search, CandidateSearch::kBoundaryAndHole);
  config.method = "S";
  EXPECT_EQ(MakeRunSettings(config).end, EndRule::kUnknownSettled);
}

TEST(RunSettings, AnUnknownMethodIsRefused) {
  RunConfig config;
  config.method = "S/B";
  EXPECT_THROW(MakeRunSettings(config), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
