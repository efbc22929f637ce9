#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/config/run_config.h"
#include "common/planning/method.h"
#include "services/planner/information_gain.h"
#include "services/planner/surface_view.h"

namespace nbs {

/// Everything that gains are calculated from, over all rounds.
struct RatingContext {
  GainRule rule = GainRule::kSurface;
  bool by_gain = true;          ///< False: the order of class and position counts, and every gain is 0 (method B).
  double gain_reach_m = 0.025;  ///< For GainRule::kNearSurface.
  GainSampling ranking = kSixtyFourth;
  int threads = 2;
  CellConfig cell;
};

/// The information gain of candidates (section III-D) in one round, under the run's gain rule.
class CandidateRating {
 public:
  /// Keeps references to `voxels` and `prediction`.
  CandidateRating(const RatingContext& context, const VoxelGrid& voxels, const SurfacePrediction& prediction);

  /// Gains in nats, of a part of the beams or of the predicted surface.
  std::vector<double> EstimateGains(std::span<const ScanPath> paths) const;
  /// Gain in nats, of all beams.
  double CalcGain(const ScanPath& path) const;
  /// What candidates are ordered by, the higher the better.
  double CalcScore(const Candidate& candidate, double gain_nat, const Pose& X_WS_now) const;

 private:
  bool is_surface() const { return context_.rule == GainRule::kSurface; }

  const RatingContext& context_;
  const SurfacePrediction& prediction_;
  double voxel_m_;
  InformationGain gain_;
  SurfaceView view_;
  std::optional<GainMap> map_;  ///< Of the rules that count cells along beams.
};

}  // namespace nbs
