#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/run_config.h"
#include "common/planning/method.h"
#include "common/runtime/node.h"

namespace nbs {

/// When a run ends and when it turns from boundaries to holes.
struct RunSettings {
  double completeness = 0.9875;  ///< Wanted mesh completeness (section III-F, eq. 3), 0 to 1.
  int max_scans = 30;            ///< >= 1.
  // The wanted completeness counts only once the surface has stopped growing: eq. 3 rises merely because n_total does.
  // It has when `settled_scans` in a row each added less than this share to the edges.
  double complete_growth = 0.01;
  CandidateSearch search = CandidateSearch::kBoundaryAndHole;
  EndRule end = EndRule::kCompleteness;
  /// kUnknownSettled: a scan that takes less than this share of all voxels that were unknown at the start was the last.
  double settled_unknown = 0.01;
  // The mesh completeness "hardly changed" (section III) when so many boundary scans in a row each closed less than
  // `settled_closing` of what was missing, 1 - completeness, and added less than `settled_growth` to the edges of the
  // mesh.
  int settled_scans = 2;
  double settled_closing = 0.10;
  double settled_growth = 0.05;
};

/// Settings of a run.
///
/// @throws std::invalid_argument if the method is unknown.
RunSettings MakeRunSettings(const RunConfig& config);

/// What the state machine waits for.
enum class Awaiting : uint8_t { kPlan, kExecution, kMeshScan, kNothing };

/// Where a run stands.
struct RunLogicState {
  Awaiting awaiting = Awaiting::kPlan;
  int32_t scan = 0;  ///< Planned or scanned now.
  PlanMode mode = PlanMode::kFirst;
  int64_t utime_us = 0;               ///< Latest time seen or given.
  std::optional<MeshScan> last_scan;  ///< The mesh after the last finished scan.
  int64_t unknown_cells = 0;          ///< When the last plan was made.
  int64_t unknown_at_start = 0;       ///< When the first plan was made.
  int grown_out = 0;                  ///< Scans in a row that hardly added to the mesh.
  int settled = 0;                    ///< Boundary scans in a row after which the mesh had hardly changed.
};

/// A new state, and what is to be published.
struct RunStep {
  RunLogicState state;
  std::vector<Message> commands;  ///< PlanRequest, Trajectory, RunState.
};

/// The run as a state machine (Fig. 2 of Kriegel et al., "Next-Best-Scan Planning for Autonomous 3D Modeling", IROS
/// 2012): pure functions from a state and what came in to the next state and what goes out. Each command bears a time
/// one microsecond after the latest seen.
///
/// Begin asks for the first scan path.
RunStep Begin(const RunSettings& settings);

/// The planner's answer: found, its trajectory goes to the robot. Nothing found among boundaries: the same scan is
/// asked for again among holes, or the run ends if the method has none. Nothing found elsewhere: the run ends with
/// completeness_reached if the mesh is as complete as wanted, with no_candidates if the planner says that its stack is
/// empty, otherwise with nothing_reachable. No first path, or no surface seen: the run fails. Where the end
/// rule is kUnknownSettled the run ends before a scan that follows one which hardly changed the count of unknown
/// voxels.
///
/// @throws std::logic_error if no plan, or that of another scan or mode, is awaited.
RunStep Advance(const RunSettings& settings, const RunLogicState& state, const Plan& plan);

/// The robot is done: the mesh of the scan is awaited. It refused: the run fails.
///
/// @throws std::logic_error if no execution, or that of another scan, is awaited.
RunStep Advance(const RunSettings& settings, const RunLogicState& state, const Execution& execution);

/// The mesh after the scan: the run ends if it is complete or the last scan is done, otherwise the next scan is asked
/// for: on the sphere, or among boundaries until the mesh has settled, then among holes for the rest of the run.
///
/// @throws std::logic_error if no mesh, or that of another scan, is awaited.
RunStep Advance(const RunSettings& settings, const RunLogicState& state, const MeshScan& mesh);

/// True if the mesh after the last scan is complete: as wanted, and grown out (RunSettings: complete_growth).
bool IsComplete(const RunSettings& settings, const RunLogicState& state);

/// True if the mesh `after` a scan has hardly changed from that `before` it (RunSettings: settled_closing,
/// settled_growth).
bool HasHardlyChanged(const RunSettings& settings, const MeshScan& before, const MeshScan& after);

}  // namespace nbs
