#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/mesh_delta.h"
#include "common/planning/scan_path.h"
#include "sim/motion_audit.h"
#include "sim/remainder.h"

namespace nbs {

/// What the truth says about a mesh; known in simulation only. Section IV-B of the paper and sim/coverage.
struct Evaluation {
  double coverage = 0.0;             ///< c_o: share of the truth's surface with a partner in the reconstruction.
  double observable_coverage = 0.0;  ///< The same share of the surface that the profiler can see at all.
  double rmse_m = 0.0;               ///< Root mean square distance of the vertices from the truth.
};

/// One scan and the selection before it, in figures.
struct ScanRecord {
  int scan = 0;
  PlanMode mode = PlanMode::kFirst;
  CandidateSource source = CandidateSource::kFirst;
  double gain_nat = 0.0;  ///< 0 where the choice did not rest on a gain.
  ScanPath path;
  int stripes = 0;
  int64_t points = 0;
  PlanTiming timing;
  double completeness = 0.0;  ///< Eq. 3, after the scan.
  double rim_length_m = 0.0;
  int64_t triangles = 0;
  int64_t edges = 0;
  std::optional<Evaluation> evaluation;
  int candidates = 0;
  std::array<int, kVerdicts> verdicts{};  ///< Candidates by verdict, all rounds before this scan.
  int64_t scanned_utime_us = 0;           ///< Robot time at the end of the scan.

  bool by_gain() const { return gain_nat > 0.0; }
};

/// The end of a run that never came to one.
inline constexpr const char* kInterrupted = "interrupted";

/// A run as far as it went.
struct RunRecord {
  std::vector<ScanRecord> scans;  ///< Complete scans only.
  std::string end_reason = kInterrupted;
  std::string detail;
  bool failed = false;
  int64_t refused_measurements = 0;
  std::array<int, kVerdicts> last_verdicts{};  ///< Of the rounds after the last scan: why nothing more was scanned.
  PlanTiming last_timing;                      ///< Of the same rounds.
};

/// Where the time of a run went, seconds: simulated robot time for motion and scan, time on the wall for the rest.
struct TimeSplit {
  double motion_s = 0.0;         ///< Between the scan paths.
  double scan_s = 0.0;           ///< On them.
  std::optional<double> map_s;   ///< Folding stripes into the voxel space.
  std::optional<double> mesh_s;  ///< Folding them into the mesh.
  double selection_s = 0.0;      ///< Candidates and their gain, of all rounds.
  double planning_s = 0.0;       ///< Whether the robot can drive the candidates, and how.
};

/// What the registration of all scans with each other has made of a run.
struct Registration {
  MeshScan figures;                      ///< Of the mesh that was made anew.
  std::optional<Evaluation> evaluation;  ///< Of the same mesh.
  double mean_correction_m = 0.0;        ///< By how much stripes were moved, in the mean
  double largest_correction_m = 0.0;     ///< and at most.
};

/// How good the final mesh is as a shape: laid onto the true object by the rigid motion that fits best
/// (sim/rigid_fit.h), because an arm's absolute error moves all of it alike.
struct Shape {
  Evaluation evaluation;    ///< Of the mesh so moved.
  double moved_m = 0.0;     ///< By how much the middle of the object was moved,
  double turned_rad = 0.0;  ///< and how far turned.
};

/// What is known about a run when it is over, most of it from the truth; empty where no truth is known.
struct Findings {
  std::optional<Remainder> remainder;  ///< What the last mesh lacks; none without a scan.
  std::optional<MotionAudit> motion;   ///< What the executed motions did.
  int64_t refused_states = 0;          ///< Robot states that had not a value for each joint of the arm.
  TimeSplit time;
  std::optional<Registration> registration;  ///< None: the cell does not ask for it, or nothing was scanned.
  std::optional<Shape> shape;                ///< None: no arm, or no truth, or nothing was scanned.
};

/// True if the run says so of itself, or was interrupted.
bool HasFailed(const RunRecord& record);

/// The mesh that a run leaves, in figures.
struct FinalMesh {
  double completeness = 0.0;
  double rim_length_m = 0.0;
  int64_t triangles = 0;
  std::optional<Evaluation> evaluation;
};

/// The mesh after the last scan as it was streamed; nullopt without a scan.
std::optional<FinalMesh> FindStreamedMesh(const RunRecord& record);

/// The mesh of the registered scans, if they have been registered, otherwise the one that was streamed.
std::optional<FinalMesh> FindFinalMesh(const RunRecord& record, const Findings& findings);

/// Length of all scan paths, metres (without the motions between them).
double CalcPathLength(const RunRecord& record);

/// Wall-clock time of all rounds of planning, in `selection_s` and `planning_s`; the rest is left as it is.
void AddPlanning(const RunRecord& record, TimeSplit& split);

/// Wall-clock durations of all motion plans, seconds, rising.
std::vector<double> CollectPlanTimes(const RunRecord& record);

/// Mean wall-clock duration of a selection, seconds; nullopt if no scan was selected (the first path is set
/// beforehand).
std::optional<double> CalcMeanSelection(const RunRecord& record);

}  // namespace nbs
