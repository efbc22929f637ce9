#include "services/planner/candidate_rating.h"

namespace nbs {

CandidateRating::CandidateRating(const RatingContext& context, const VoxelGrid& voxels,
                                 const SurfacePrediction& prediction)
    : context_(context),
      prediction_(prediction),
      voxel_m_(voxels.shape().resolution_m),
      gain_(context.cell.profiler),
      view_(context.cell.profiler) {
  if (context.by_gain && !is_surface()) map_.emplace(voxels, context.rule, context.gain_reach_m);
}

std::vector<double> CandidateRating::EstimateGains(std::span<const ScanPath> paths) const {
  if (!context_.by_gain) return std::vector<double>(paths.size(), 0.0);
  if (is_surface()) return view_.CalcGains(prediction_, paths, voxel_m_, context_.threads, kRankingStep);
  std::vector<double> gains_nat;
  gains_nat.reserve(paths.size());
  for (int64_t gain : gain_.CalcAll(*map_, paths, context_.ranking, context_.threads))
    gains_nat.push_back(ToNats(gain));
  return gains_nat;
}

double CandidateRating::CalcGain(const ScanPath& path) const {
  if (!context_.by_gain) return 0.0;
  return is_surface() ? view_.CalcGain(prediction_, path, voxel_m_)
                      : ToNats(gain_.Calc(*map_, path, kAllBeams, context_.threads));
}

double CandidateRating::CalcScore(const Candidate& candidate, double gain_nat, const Pose& X_WS_now) const {
  if (!context_.by_gain) {
    // The boundaries of the newest scan first, by class and position: so the way leads around the object.
    constexpr double kMostOfAScan = 1e6;
    return kMostOfAScan * candidate.born_scan - candidate.rank;
  }
  const ScanPath& path = candidate.path;
  const double way_m = (path.X_WS_start.translation() - X_WS_now.translation()).norm();
  const PathCost cost = {.beams = gain_.CountBeams(path),
                         .seconds = way_m / context_.cell.move_speed_m_per_s +
                                    path.length_m() / context_.cell.profiler.scan_speed_m_per_s};
  return nbs::CalcScore(context_.rule, gain_nat, cost);
}

}  // namespace nbs
