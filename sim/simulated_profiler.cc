#include "sim/simulated_profiler.h"

#include <algorithm>
#include <cmath>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {}  // namespace

SimulatedProfiler::SimulatedProfiler(const TriangleScene& scene_W, const Profiler& profiler, uint64_t seed,
                                     uint32_t dark_from)
    : scene_W_(&scene_W),
      profiler_(profiler),
      seed_(seed),
      dark_from_(dark_from),
      min_cosine_(std::cos(profiler.max_incidence_rad)),
      directions_S_(CalcBeamDirections_S(profiler)) {}

std::vector<uint8_t> SimulatedProfiler::FindReturns(const Pose& X_WS, const std::vector<Ray>& rays,
                                                    const std::vector<RayHit>& hits) const {
  std::vector<uint8_t> returns(rays.size(), 0);
  std::vector<TriangleScene::Segment> sights(rays.size());
  const Eigen::Vector3d p_WC = X_WS * CalcCamera_S(profiler_);
  const bool has_camera = profiler_.HasCamera();
  for (size_t i = 0; i < rays.size(); ++i) {
    const RayHit& hit = hits[i];
    if (!hit.hit() || hit.triangle >= dark_from_) continue;
    const double depth = hit.distance_m * directions_S_[i].z();
    if (depth < profiler_.min_depth_m || depth > profiler_.max_depth_m) continue;
    if (-hit.normal_W.dot(rays[i].direction_W) < min_cosine_) continue;
    const Eigen::Vector3d p_W = rays[i].p_W + hit.distance_m * rays[i].direction_W;
    if (has_camera && hit.normal_W.dot(p_WC - p_W) <= 0.0) continue;
    returns[i] = 1;
    sights[i] = {p_W, p_WC};
  }
  if (!has_camera) return returns;
  // Sights of beams without return stay zero-length and are never blocked.
  const std::vector<uint8_t> blocked = scene_W_->FindBlocked(sights, kSurfaceSkip_m);
  for (size_t i = 0; i < returns.size(); ++i) returns[i] = returns[i] != 0 && blocked[i] == 0;
  return returns;
}

std::vector<float> SimulatedProfiler::TakeProfile(const Pose& X_WS, int32_t scan, int32_t stripe) const {
  std::vector<Ray> rays(directions_S_.size());
  for (size_t i = 0; i < rays.size(); ++i) rays[i] = {X_WS.translation(), X_WS.linear() * directions_S_[i]};
  // The outermost beams are the longest within the depth of field.
  const double reach_m = profiler_.max_depth_m / std::min(directions_S_.front().z(), directions_S_.back().z()) * 1.001;
  const std::vector<RayHit> hits = scene_W_->CastRays(rays, reach_m);
  const std::vector<uint8_t> returns = FindReturns(X_WS, rays, hits);
  std::vector<float> ranges_m(rays.size(), 0.0f);
  for (size_t i = 0; i < rays.size(); ++i) {
    if (returns[i] == 0) continue;
    const double depth = hits[i].distance_m * directions_S_[i].z();
    const double noise = CalcGaussian({seed_, static_cast<uint64_t>(scan), static_cast<uint64_t>(stripe), i});
    ranges_m[i] = static_cast<float>(std::max(hits[i].distance_m + CalcRangeSigma(profiler_, depth) * noise, 1e-4));
  }
  return ranges_m;
}

}  // namespace nbs
