#pragma once

#include <functional>
#include <vector>

#include "common/config/run_config.h"
#include "common/geometry/mesh_delta.h"
#include "common/planning/method.h"
#include "services/planner/scan_selection.h"
#include "services/planner/surface_prediction.h"

namespace nbs {

/// What the planner knows when it searches.
struct SearchInput {
  const MeshReplica& mesh;
  const VoxelGrid& voxels;
  const SurfacePrediction& prediction;
  int32_t newest_scan;  ///< Last scan folded in; -1 before the first.
  ScanPath newest_path;
  std::function<bool(const ScanPath&)> could_drive;  ///< As in SurfaceSearchSettings.
};

/// Keeps the stack of candidates after the mode of the round and the run's method (Fig. 2, sections III-A, III-B).
///
/// - First: the cell's first path.
/// - Boundary: beside the boundaries of the newest scan, added to the stack; under GainRule::kSurface over the
///   predicted surface, where the stack is made anew because the prediction has changed everywhere. A method without
///   gain gets one path a boundary, and forgets those whose middle has been seen meanwhile.
/// - Hole: the boundary candidates are dropped and the holes detected once; under GainRule::kSurface in every round,
///   beside the predicted surface.
/// - Sphere: all viewpoints, once.
class CandidateSearcher {
 public:
  CandidateSearcher(const RunConfig& config, int threads);

  void Update(PlanMode mode, const SearchInput& input, ScanSelection& selection);

 private:
  std::vector<Candidate> FindCandidates(PlanMode mode, const SearchInput& input, ScanSelection& selection);
  std::vector<Candidate> FindFirst() const;
  std::vector<Candidate> FindOverPrediction(PlanMode mode, const SearchInput& input) const;
  std::vector<Candidate> FindBesideBoundaries(const SearchInput& input, ScanSelection& selection) const;

  RunConfig config_;
  Method method_;
  bool over_prediction_;
  int threads_;
  int32_t next_id_ = 0;
  int32_t searched_scan_ = -1;  ///< Last scan whose boundaries were searched.
  bool holes_detected_ = false;
  bool sphere_proposed_ = false;
};

}  // namespace nbs
