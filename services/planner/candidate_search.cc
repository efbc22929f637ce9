#include "services/planner/candidate_search.h"

#include <utility>

#include "common/mapping/ray_walk.h"
#include "services/planner/boundary_search.h"
#include "services/planner/hole_detection.h"
#include "services/planner/sphere_search.h"
#include "services/planner/surface_search.h"

namespace nbs {
namespace {

/// One path a boundary, straight on: what a method without gain can choose from.
BoundarySearchSettings MakePlainSettings() {
  BoundarySearchSettings settings;
  settings.one_path_per_chain = true;
  return settings;
}

/// True if there is measured surface within two voxels of what the middle of a path looks at.
bool IsSeen(const VoxelGrid& voxels, const ScanPath& path, double standoff_m) {
  constexpr int kReach = 2;
  const Eigen::Vector3d middle_W = 0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation());
  const Eigen::Vector3d target_W = middle_W + standoff_m * path.X_WS_start.linear().col(2);
  const GridShape& shape = voxels.shape();
  for (int dz = -kReach; dz <= kReach; ++dz) {
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const int64_t cell = FindCell(shape, target_W + shape.resolution_m * Eigen::Vector3d(dx, dy, dz));
        if (cell >= 0 && IsOccupied(voxels.cells()[cell])) return true;
      }
    }
  }
  return false;
}

Eigen::AlignedBox3d MakeObjectBox(const RunConfig& config) {
  const Eigen::Vector3d margin_m = Eigen::Vector3d::Constant(config.cell.unknown_margin_m);
  const Eigen::Vector3d sizes_m = config.grid.resolution_m * config.grid.size.cast<double>();
  return {config.grid.origin_W + margin_m, config.grid.origin_W + sizes_m - margin_m};
}

}  // namespace

CandidateSearcher::CandidateSearcher(const RunConfig& config, int threads)
    : config_(config),
      method_(FindMethod(config.method)),
      over_prediction_(method_.by_gain && config.gain == ToString(GainRule::kSurface)),
      threads_(threads) {}

void CandidateSearcher::Update(PlanMode mode, const SearchInput& input, ScanSelection& selection) {
  std::vector<Candidate> candidates = FindCandidates(mode, input, selection);
  for (Candidate& candidate : candidates) candidate.id = next_id_++;
  selection.Add(candidates);
}

std::vector<Candidate> CandidateSearcher::FindCandidates(PlanMode mode, const SearchInput& input,
                                                         ScanSelection& selection) {
  if (mode == PlanMode::kFirst) return FindFirst();
  if (mode == PlanMode::kSphere) {
    if (std::exchange(sphere_proposed_, true)) return {};
    return FindSphereCandidates(MakeObjectBox(config_), input.newest_scan);
  }
  if (over_prediction_) {
    selection.Remove([](const Candidate&) { return true; });
    return FindOverPrediction(mode, input);
  }
  if (mode == PlanMode::kBoundary) {
    if (std::exchange(searched_scan_, input.newest_scan) == input.newest_scan) return {};
    return FindBesideBoundaries(input, selection);
  }
  if (std::exchange(holes_detected_, true)) return {};
  selection.Drop(CandidateSource::kBoundary);
  return FindHoleCandidates(BoundarySurface(input.mesh), input.newest_scan, config_.cell.profiler);
}

/// What the sensor sees matters less than that it can be there: with a camera it may stand on either side.
std::vector<Candidate> CandidateSearcher::FindFirst() const {
  std::vector<Candidate> candidates = {{.source = CandidateSource::kFirst, .path = config_.first_path}};
  if (!config_.cell.profiler.HasCamera()) return candidates;
  candidates.push_back({.source = CandidateSource::kFirst, .rank = 1, .path = RollPath(config_.first_path)});
  return candidates;
}

std::vector<Candidate> CandidateSearcher::FindOverPrediction(PlanMode mode, const SearchInput& input) const {
  const bool holes = mode == PlanMode::kHole;
  std::vector<Candidate> candidates;
  SurfaceSearchSettings settings;
  settings.threads = threads_;
  settings.could_drive = input.could_drive;
  for (const ScanPath& path : FindSurfacePaths(input.prediction, SurfaceView(config_.cell.profiler),
                                               config_.cell.profiler, config_.grid.resolution_m, settings)) {
    candidates.push_back({.source = holes ? CandidateSource::kHole : CandidateSource::kBoundary,
                          .born_scan = input.newest_scan,
                          .rank = static_cast<int32_t>(candidates.size()),
                          .path = path});
  }
  if (holes) {
    const std::vector<Candidate> detected =
        FindHoleCandidates(BoundarySurface(input.mesh), input.newest_scan, config_.cell.profiler);
    candidates.insert(candidates.end(), detected.begin(), detected.end());
  }
  return candidates;
}

std::vector<Candidate> CandidateSearcher::FindBesideBoundaries(const SearchInput& input,
                                                               ScanSelection& selection) const {
  const BoundarySurface surface(input.mesh);
  const Profiler& profiler = config_.cell.profiler;
  if (method_.by_gain) return FindBoundaryCandidates(surface, input.newest_scan, input.newest_path, profiler);
  const auto is_seen = [&](const Candidate& candidate) {
    return IsSeen(input.voxels, candidate.path, profiler.standoff_m);
  };
  selection.Remove(is_seen);
  std::vector<Candidate> candidates =
      FindBoundaryCandidates(surface, input.newest_scan, input.newest_path, profiler, MakePlainSettings());
  std::erase_if(candidates, is_seen);
  return candidates;
}

}  // namespace nbs
