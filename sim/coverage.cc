#include "sim/coverage.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/directions.h"
#include "sim/mesh_measures.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// No vertex of a reconstruction lies farther from the truth.
constexpr double kFar_m = 10.0;

}  // namespace

CoverageOracle::CoverageOracle(const TriangleMesh& truth_W, const CoverageSettings& settings)
    : settings_(settings), truth_W_(truth_W), samples_(MakeSurfaceSamples(truth_W, settings.samples)) {
  FindObservable();
}

void CoverageOracle::FindObservable() {
  observable_.assign(samples_.size(), 0);
  std::vector<Vector3d> directions = MakeSphereDirections(kSightDirections);
  const double min_cosine = std::cos(settings_.profiler.max_incidence_rad);
  const double depth = settings_.profiler.min_depth_m;
  const double lowest = settings_.table_z_m.value_or(-std::numeric_limits<double>::infinity());
  std::vector<size_t> open(samples_.size());
  for (size_t i = 0; i < open.size(); ++i) open[i] = i;
  // First along the normal itself, which settles nearly all, then the fixed set for those that are left.
  for (int d = -1; d < kSightDirections && !open.empty(); ++d) {
    std::vector<TriangleScene::Segment> sights;
    std::vector<size_t> tried;
    for (size_t i : open) {
      const SurfaceSample& sample = samples_[i];
      const Vector3d direction = d < 0 ? sample.normal_W : directions[d];
      const Vector3d end = sample.p_W + depth * direction;
      if (direction.dot(sample.normal_W) < min_cosine || end.z() < lowest) continue;
      sights.push_back({sample.p_W, end});
      tried.push_back(i);
    }
    const std::vector<uint8_t> blocked = truth_W_.FindBlocked(sights, kSurfaceSkip_m);
    for (size_t k = 0; k < tried.size(); ++k) observable_[tried[k]] |= blocked[k] == 0;
    std::erase_if(open, [this](size_t i) { return observable_[i] != 0; });
  }
  observable_share_ = static_cast<double>(std::count(observable_.begin(), observable_.end(), 1)) / samples_.size();
}

double CoverageOracle::CalcRmse(const TriangleMesh& mesh_W) const {
  const std::vector<Vector3d> used_W = CollectUsedVertices(mesh_W);
  double sum = 0.0;
  for (const Vector3d& p_W : used_W) {
    const auto closest = truth_W_.FindClosest(p_W, kFar_m);
    const double distance = closest ? closest->distance_m : kFar_m;
    sum += distance * distance;
  }
  return used_W.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(used_W.size()));
}

std::vector<uint8_t> CoverageOracle::FindCovered(const TriangleMesh& mesh_W) const {
  const TriangleScene scene(mesh_W);
  const double min_cosine = std::cos(settings_.max_angle_rad);
  std::vector<uint8_t> covered;
  covered.reserve(samples_.size());
  for (const SurfaceSample& sample : samples_) {
    const auto partner = scene.FindClosestFacing(sample.p_W, settings_.max_distance_m, sample.normal_W, min_cosine);
    covered.push_back(partner.has_value());
  }
  return covered;
}

Coverage CoverageOracle::Evaluate(const TriangleMesh& mesh_W) const {
  const std::vector<uint8_t> is_covered = FindCovered(mesh_W);
  int64_t covered = 0, observable = 0, both = 0;
  for (size_t i = 0; i < samples_.size(); ++i) {
    covered += is_covered[i];
    observable += observable_[i];
    both += is_covered[i] != 0 && observable_[i] != 0;
  }
  Coverage result;
  result.coverage = static_cast<double>(covered) / static_cast<double>(samples_.size());
  result.observable_coverage = observable > 0 ? static_cast<double>(both) / static_cast<double>(observable) : 0.0;
  result.rmse_m = CalcRmse(mesh_W);
  return result;
}

}  // namespace nbs
