#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/config/run_config.h"
#include "common/geometry/mesh_delta.h"
#include "common/mapping/voxel_grid.h"
#include "common/runtime/node.h"
#include "services/planner/information_gain.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "services/planner/scan_selection.h"

namespace nbs {

struct PlannerSettings {
  GainRule gain_rule = GainRule::kNearSurface;
  double gain_reach_m = 0.025;  ///< For kNearSurface.
  double min_gain_nat =
      20.0;  ///< A candidate that promises less is not worth a motion: about thirty cells that were never observed.
  int gain_threads = 2;
};

/// The planner without the bus: answers each request with the next best scan (Fig. 2, sections III-A to III-E).
///
/// After each scan it reads that scan's mesh and voxel changes to their end, then the next request: an answer thus
/// always rests on all scans before it.
class PlannerNode : public Node {
 public:
  /// Wall clock in seconds for the timing messages; it reaches nothing else.
  using Clock = std::function<double()>;

  PlannerNode(const RunConfig& config, Clock clock, const PlannerSettings& settings = {});

  size_t NextInput() const override { return next_input_; }
  void Handle(const Message& message, Outbox& out) override;

 private:
  void Answer(const PlanRequest& request, Outbox& out);
  void AddCandidates(PlanMode mode);
  ScanSelection::Result Select(const PlanRequest& request, PlanTiming& timing);
  SelectionTools MakeTools(const PlanRequest& request, const Clearance& clearance, const GainMap& gain_map,
                           PlanTiming& timing) const;

  RunConfig config_;
  PlannerSettings settings_;
  Clock clock_;
  size_t next_input_;
  MeshReplica mesh_;
  VoxelGrid voxels_;
  InformationGain gain_;
  MotionPlanner motion_;
  ScanSelection selection_;
  bool holes_detected_ = false;  ///< Detected once (section III-B).
  int32_t next_candidate_id_ = 0;
  int32_t newest_scan_ = -1;    ///< Last scan folded in.
  int32_t searched_scan_ = -1;  ///< Last scan whose boundaries were searched.
  ScanPath newest_path_;
  Pose X_WS_now_;  ///< Where the sensor stands after the last plan.
};

}  // namespace nbs
