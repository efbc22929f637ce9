#include "services/coordinator/run_logic.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

namespace nbs {
namespace {

void CheckAwaited(const RunLogicState& state, Awaiting awaited, int32_t scan, std::string_view what) {
  if (state.awaiting == awaited && state.scan == scan) return;
  throw std::logic_error(fmt::format("coordinator: {} of scan {} is not what scan {} awaits", what, scan, state.scan));
}

RunStep Finish(RunLogicState state, int32_t scans, bool failed, std::string end_reason, std::string detail) {
  state.awaiting = Awaiting::kNothing;
  RunState finished{++state.utime_us, scans, RunPhase::kFinished, state.mode, failed, std::move(end_reason),
                    std::move(detail)};
  return {state, {std::move(finished)}};
}

RunStep AskForPlan(RunLogicState state, int32_t scan, PlanMode mode) {
  state.awaiting = Awaiting::kPlan;
  state.scan = scan;
  state.mode = mode;
  ++state.utime_us;
  return {state,
          {RunState{state.utime_us, scan, RunPhase::kPlanning, mode, false, {}, {}},
           PlanRequest{state.utime_us, scan, mode}}};
}

RunStep Execute(RunLogicState state, const Plan& plan) {
  state.awaiting = Awaiting::kExecution;
  Trajectory trajectory = plan.trajectory;
  trajectory.utime_us = ++state.utime_us;
  trajectory.scan = state.scan;
  return {
      state,
      {RunState{state.utime_us, state.scan, RunPhase::kScanning, state.mode, false, {}, {}}, std::move(trajectory)}};
}

std::string ExplainCompleteness(const RunSettings& settings, const MeshScan& mesh) {
  return fmt::format("Mesh completeness {:.4f} of {:.4f} wanted.", mesh.completeness, settings.completeness);
}

RunStep GiveUp(const RunSettings& settings, const RunLogicState& state, const Plan& plan) {
  const bool first = state.mode == PlanMode::kFirst;
  if (settings.end == EndRule::kCompleteness && state.last_scan &&
      state.last_scan->completeness >= settings.completeness) {
    return Finish(state, state.scan, false, "completeness_reached", ExplainCompleteness(settings, *state.last_scan));
  }
  const std::string end_reason = plan.stack_is_empty ? "no_candidates" : "nothing_reachable";
  if (!first && state.last_scan && state.last_scan->edges == 0) {
    return Finish(state, state.scan, true, end_reason, "No scan has seen any surface: does the first path look at it?");
  }
  return Finish(state, state.scan, first, end_reason, plan.reason);
}

PlanMode ChooseMode(const RunSettings& settings, const RunLogicState& state) {
  if (settings.search == CandidateSearch::kSphere) return PlanMode::kSphere;
  if (settings.search == CandidateSearch::kBoundary) return PlanMode::kBoundary;
  const bool settled = state.settled >= settings.settled_scans;
  return state.mode == PlanMode::kHole || settled ? PlanMode::kHole : PlanMode::kBoundary;
}

/// Whether the last scan hardly changed the count of unknown voxels; the first never is the last.
bool IsUnknownSettled(const RunSettings& settings, const RunLogicState& state, const Plan& plan) {
  if (settings.end != EndRule::kUnknownSettled || state.scan < 2) return false;
  const auto taken = static_cast<double>(state.unknown_cells - plan.unknown_cells);
  return taken < settings.settled_unknown * static_cast<double>(state.unknown_at_start);
}

/// Share of edges that a scan added to the mesh before it.
double CalcGrowth(const MeshScan& before, const MeshScan& after) {
  return static_cast<double>(after.edges - before.edges) / static_cast<double>(std::max<int64_t>(before.edges, 1));
}

}  // namespace

RunSettings MakeRunSettings(const RunConfig& config) {
  const Method& method = FindMethod(config.method);
  RunSettings settings;
  settings.completeness = config.completeness;
  settings.max_scans = config.max_scans;
  settings.search = method.search;
  settings.end = method.end;
  return settings;
}

bool IsComplete(const RunSettings& settings, const RunLogicState& state) {
  return settings.end == EndRule::kCompleteness && state.grown_out >= settings.settled_scans &&
         state.last_scan.value().completeness >= settings.completeness;
}

bool HasHardlyChanged(const RunSettings& settings, const MeshScan& before, const MeshScan& after) {
  const double missing = 1.0 - before.completeness;
  const double closed = after.completeness - before.completeness;
  return closed < settings.settled_closing * missing && CalcGrowth(before, after) < settings.settled_growth;
}

RunStep Begin(const RunSettings& /*settings*/) { return AskForPlan({}, 0, PlanMode::kFirst); }

RunStep Advance(const RunSettings& settings, const RunLogicState& state, const Plan& plan) {
  CheckAwaited(state, Awaiting::kPlan, plan.scan, "a plan");
  if (plan.mode != state.mode) throw std::logic_error("coordinator: the plan is of another mode than asked for");
  RunLogicState next = state;
  next.utime_us = std::max(next.utime_us, plan.utime_us);
  next.unknown_cells = plan.unknown_cells;
  if (state.mode == PlanMode::kFirst) next.unknown_at_start = plan.unknown_cells;
  if (plan.found && IsUnknownSettled(settings, state, plan)) {
    return Finish(next, state.scan, false, "unknown_settled",
                  fmt::format("{} voxels are still unknown; {} were before the last scan.", plan.unknown_cells,
                              state.unknown_cells));
  }
  if (plan.found) return Execute(next, plan);
  if (state.mode == PlanMode::kBoundary && settings.search == CandidateSearch::kBoundaryAndHole)
    return AskForPlan(next, state.scan, PlanMode::kHole);
  return GiveUp(settings, next, plan);
}

RunStep Advance(const RunSettings& /*settings*/, const RunLogicState& state, const Execution& execution) {
  CheckAwaited(state, Awaiting::kExecution, execution.scan, "an execution");
  RunLogicState next = state;
  next.utime_us = std::max(next.utime_us, execution.utime_us);
  if (!execution.done) return Finish(next, state.scan, true, "refused", execution.refusal);
  next.awaiting = Awaiting::kMeshScan;
  return {next, {}};
}

RunStep Advance(const RunSettings& settings, const RunLogicState& state, const MeshScan& mesh) {
  CheckAwaited(state, Awaiting::kMeshScan, mesh.scan, "a mesh");
  RunLogicState next = state;
  next.utime_us = std::max(next.utime_us, mesh.utime_us);
  const bool hardly =
      state.last_scan && state.mode == PlanMode::kBoundary && HasHardlyChanged(settings, *state.last_scan, mesh);
  next.settled = hardly ? state.settled + 1 : 0;
  const bool grown_out = state.last_scan && CalcGrowth(*state.last_scan, mesh) < settings.complete_growth;
  next.grown_out = grown_out ? state.grown_out + 1 : 0;
  next.last_scan = mesh;
  const int32_t scans = state.scan + 1;
  if (IsComplete(settings, next)) {
    return Finish(next, scans, false, "completeness_reached", ExplainCompleteness(settings, mesh));
  }
  if (scans >= settings.max_scans) {
    return Finish(next, scans, false, "scan_limit",
                  fmt::format("{} scans done; mesh completeness {:.4f} of {:.4f} wanted.", scans, mesh.completeness,
                              settings.completeness));
  }
  const PlanMode mode = ChooseMode(settings, next);
  return AskForPlan(next, scans, mode);
}

}  // namespace nbs
