#include "services/voxelmap/inverse_sensor_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/runtime/error.h"

namespace nbs {
namespace {

/// The sensor service cuts at the depth of field; a float range may lie this much beyond it.
constexpr double kDepthTolerance = 1e-3;

int16_t ToStep(const char* name, double nat) {
  if (!(nat > 0.0 && nat < 16.0))
    throw ConfigError(std::string(name) + " is " + std::to_string(nat) + ": choose between 0 and 16 nats");
  return static_cast<int16_t>(std::lround(nat * kLogOddsPerNat));
}

/// The point `distance` before B on the way from A to B; A itself if B is nearer than that.
Eigen::Vector3d CalcPointBefore(const Eigen::Vector3d& p_A, const Eigen::Vector3d& p_B, double distance) {
  const double length = (p_B - p_A).norm();
  if (length <= distance) return p_A;
  return p_A + (p_B - p_A) * ((length - distance) / length);
}

}  // namespace

LogOddsSteps MakeLogOddsSteps(const InverseSensorModelSettings& settings) {
  const bool ordered = settings.min_probability > 0.0 && settings.min_probability < 0.5 &&
                       settings.max_probability > 0.5 && settings.max_probability < 1.0;
  if (!ordered)
    throw ConfigError("the clamps of the voxel space must keep 0 < min_probability < 0.5 < max_probability < 1");
  LogOddsSteps steps;
  steps.hit = ToStep("hit_nat", settings.hit_nat);
  steps.miss = ToStep("miss_nat", settings.miss_nat);
  steps.lowest = CalcLogOdds(settings.min_probability);
  steps.highest = CalcLogOdds(settings.max_probability);
  if (!IsOccupied(steps.highest)) throw ConfigError("max_probability is below 0.95: no cell would ever be occupied");
  if (steps.lowest + steps.hit < kOccupiedLogOdds) {
    throw ConfigError("hit_nat is " + std::to_string(settings.hit_nat) +
                      ": one hit on a free cell must make it occupied, choose a larger one");
  }
  return steps;
}

StripeEvidence CalcStripeEvidence(const Profiler& profiler, const std::vector<Eigen::Vector3d>& directions_S,
                                  double free_margin_sigma, const Stripe& stripe, StripeEvidence memory) {
  StripeEvidence evidence = std::move(memory);
  const Eigen::Vector3d p_WS = stripe.X_WS.translation();
  const bool has_camera = profiler.HasCamera();
  evidence.hits_W.clear();
  evidence.fans.resize(has_camera ? 2 : 1);
  for (FreeFan& fan : evidence.fans) fan.ends_W.clear();
  evidence.fans[0].p_WA = p_WS;
  if (has_camera) evidence.fans[1].p_WA = stripe.X_WS * CalcCamera_S(profiler);
  for (size_t i = 0; i < stripe.ranges_m.size(); ++i) {
    const double range = stripe.ranges_m[i];
    const double depth = range * directions_S[i].z();
    if (!(range > 0.0) || depth < profiler.min_depth_m - kDepthTolerance ||
        depth > profiler.max_depth_m + kDepthTolerance)
      continue;
    const Eigen::Vector3d beam_W = stripe.X_WS.linear() * directions_S[i];
    const Eigen::Vector3d p_WP = p_WS + range * beam_W;
    const double margin = free_margin_sigma * CalcRangeSigma(profiler, depth);
    evidence.hits_W.push_back(p_WP);
    evidence.fans[0].ends_W.push_back(p_WS + std::max(range - margin, 0.0) * beam_W);
    if (has_camera) evidence.fans[1].ends_W.push_back(CalcPointBefore(evidence.fans[1].p_WA, p_WP, margin));
  }
  return evidence;
}

}  // namespace nbs
