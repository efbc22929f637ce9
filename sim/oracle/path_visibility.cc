#include "sim/oracle/path_visibility.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr double kSameOrientation_rad = 1e-6;
/// A path that moves less than this through its light plane has no extent to see.
constexpr double kNoAdvance_m = 1e-9;

}  // namespace

PathVisibility::PathVisibility(const TriangleScene& object_W, std::span<const SurfaceSample> samples,
                               const Profiler& profiler)
    : object_W_(&object_W),
      samples_(samples),
      profiler_(profiler),
      min_cosine_(std::cos(profiler.max_incidence_rad)),
      tan_half_fan_(std::tan(0.5 * profiler.fan_rad)) {}

std::vector<uint32_t> PathVisibility::FindSeen(const ScanPath& path) const {
  if (CalcAngleBetween(path.X_WS_start, path.X_WS_end) > kSameOrientation_rad) {
    throw std::invalid_argument("PathVisibility: the sensor turns along the path");
  }
  const Vector3d p_WA = path.X_WS_start.translation();
  const Vector3d p_AB_W = path.X_WS_end.translation() - p_WA;
  const Vector3d x_W = path.X_WS_start.linear().col(0), y_W = path.X_WS_start.linear().col(1),
                 z_W = path.X_WS_start.linear().col(2);
  const double advance = y_W.dot(p_AB_W);
  if (std::abs(advance) < kNoAdvance_m) return {};
  std::vector<uint32_t> lit;
  std::vector<TriangleScene::Segment> sights, camera_sights;
  for (size_t i = 0; i < samples_.size(); ++i) {
    const Vector3d p_AP_W = samples_[i].p_W - p_WA;
    const double share = y_W.dot(p_AP_W) / advance;
    if (share < 0.0 || share > 1.0) continue;
    const Vector3d p_SP_W = p_AP_W - share * p_AB_W;
    const double depth = z_W.dot(p_SP_W);
    if (depth < profiler_.min_depth_m || depth > profiler_.max_depth_m) continue;
    if (std::abs(x_W.dot(p_SP_W)) > depth * tan_half_fan_) continue;
    if (-samples_[i].normal_W.dot(p_SP_W) < min_cosine_ * p_SP_W.norm()) continue;
    const Vector3d p_WS = p_WA + share * p_AB_W;
    const Vector3d p_WC = p_WS + profiler_.camera_baseline_m * y_W;
    if (samples_[i].normal_W.dot(p_WC - samples_[i].p_W) <= 0.0) continue;
    lit.push_back(static_cast<uint32_t>(i));
    sights.push_back({samples_[i].p_W, p_WS});
    if (profiler_.HasCamera()) camera_sights.push_back({samples_[i].p_W, p_WC});
  }
  const std::vector<uint8_t> blocked = object_W_->FindBlocked(sights, kSurfaceSkip_m);
  const std::vector<uint8_t> unseen = object_W_->FindBlocked(camera_sights, kSurfaceSkip_m);
  std::vector<uint32_t> seen;
  for (size_t k = 0; k < lit.size(); ++k) {
    if (blocked[k] == 0 && (unseen.empty() || unseen[k] == 0)) seen.push_back(lit[k]);
  }
  return seen;
}

}  // namespace nbs
