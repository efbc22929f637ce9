#include "services/mesher/ridge_evidence.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

constexpr float kMillimetre = 1e3f;

}  // namespace

void RidgeEvidence::Gather(const Tangent& at, float radius_m) {
  constexpr float kLeastViewCosine = -0.3f;  // Both sides of a ridge.
  samples_.clear();
  measurements_.Gather(at.p_W, radius_m, at.normal_W, kLeastViewCosine, samples_);
}

bool RidgeEvidence::Carries(const Roof& roof, const Tangent& at, bool lax) {
  Gather(at, settings_.roof_radius_m);
  if (samples_.empty()) return false;
  const float misfit = kMillimetre * settings_.roof_misfit_m;
  float squares = 0.0f, allowed = 0.0f;
  for (const Sample& s : samples_) {
    constexpr float kVariances = 1.5f;
    const float height = kMillimetre * roof.CalcHeight(s.p_W);
    squares += height * height;
    allowed += misfit * misfit + kVariances / s.weight;
  }
  return squares <= (lax ? 2.0f : 1.0f) * allowed;
}

bool RidgeEvidence::IsMeasured(const Roof& roof, const Roof::Feature& feature) {
  Gather(feature.tangent, std::max(settings_.near_radius_m, settings_.beside_radius_m));
  float before = 0.0f, behind = 0.0f, nearest = settings_.beside_radius_m;
  float heights = 0.0f, variance = 0.0f, count = 0.0f;
  for (const Sample& s : samples_) {
    const Eigen::Vector3f d = s.p_W - feature.tangent.p_W;
    const float along = feature.along_W.dot(d), distance = d.norm();
    behind = std::min(behind, along);
    before = std::max(before, along);
    nearest = std::min(nearest, distance);
    if (distance > settings_.near_radius_m) continue;
    heights += kMillimetre * roof.CalcHeight(s.p_W);
    variance += 1.0f / s.weight;
    count += 1.0f;
  }
  if (heights - 2.0f * std::sqrt(variance) < -kMillimetre * settings_.near_depth_m * count) return false;
  if (feature.IsCorner()) return nearest <= settings_.nearest_to_corner_m;
  return nearest <= settings_.nearest_m && std::min(before, -behind) > settings_.beside_m;
}

}  // namespace nbs
