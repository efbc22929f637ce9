#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/config/run_config.h"
#include "common/geometry/mesh_delta.h"
#include "common/mapping/voxel_grid.h"
#include "common/runtime/node.h"
#include "services/planner/candidate_rating.h"
#include "services/planner/candidate_search.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "services/planner/scan_selection.h"

namespace nbs {

struct PlannerSettings {
  /// A candidate that promises less is not worth a motion. Borders count little beside predicted surface (their strips
  /// have max_rim_share of it): 3 nat are a surface of 1 cm², or the borders of some gaps of 30 mm …
  double min_gain_nat = 3.0;
  double min_hole_gain_nat = 0.1;       ///< … and a thirtieth of that where only holes are left.
  double gain_reach_m = 0.025;          ///< For GainRule::kNearSurface.
  GainSampling ranking = kSixtyFourth;  ///< Beams by which the stack is ranked, where the rule counts beams.
  int threads = 2;
};

/// The planner without the bus: answers each request with the next best scan (Fig. 2, sections III-A to III-E).
///
/// After each scan it reads that scan's mesh and voxel changes to their end, then the next request: an answer thus
/// always rests on all scans before it.
class PlannerNode : public Node {
 public:
  /// Wall clock in seconds for the timing messages; it reaches nothing else.
  using Clock = std::function<double()>;

  /// @throws ConfigError if an arm cannot be planned for, starts in collision, or cannot drive the first path.
  PlannerNode(const RunConfig& config, Clock clock, const PlannerSettings& settings = {});

  size_t NextInput() const override { return next_input_; }
  void Handle(const Message& message, Outbox& out) override;

  /// Damaged deltas of mesh and voxels; they are left out.
  std::vector<Count> Complaints() const override;

 private:
  void Answer(const PlanRequest& request, Outbox& out);
  void FoldNewestScan();
  ScanSelection::Result Select(const PlanRequest& request, PlanTiming& timing);
  SelectionTools MakeTools(const PlanRequest& request, const Clearance& clearance, const CandidateRating& rating,
                           PlanTiming& timing) const;
  double FindMinGain(PlanMode mode) const;

  RunConfig config_;
  PlannerSettings settings_;
  Clock clock_;
  size_t next_input_;
  MeshReplica mesh_;
  VoxelGrid voxels_;
  Method method_;
  RatingContext rating_;
  MotionPlanner motion_;
  SurfacePrediction prediction_;
  CandidateSearcher searcher_;
  ScanSelection selection_;
  int64_t refused_mesh_ = 0;
  int64_t refused_voxels_ = 0;
  int32_t newest_scan_ = -1;     ///< Last scan planned.
  int32_t predicted_scan_ = -1;  ///< Last scan in the prediction.
  ScanPath newest_path_;
  RobotPosture now_;  ///< Where the robot is after the last plan.
};

}  // namespace nbs
