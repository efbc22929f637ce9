#include "sim/pose_error.h"

#include <cmath>
#include <numbers>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

constexpr uint64_t kBiasKey = 0x62696173;   // "bias"
constexpr uint64_t kNoiseKey = 0x6e6f6973;  // "nois"
constexpr double kRadiansPerMetre = 1.0;
constexpr double kRadiansPerAxis = 0.5;  // an axis of the flange moves by 2 over half a turn

/// A slow wave over positions and orientations, with a direction and a phase of its own.
double CalcWave(const Pose& X_WF, uint64_t seed, uint64_t number) {
  const auto draw = [&](uint64_t k) { return CalcGaussian({kBiasKey, seed, number, k}); };
  const Eigen::Vector3d over_place = Eigen::Vector3d(draw(0), draw(1), draw(2)).normalized();
  const Eigen::Vector3d over_view = Eigen::Vector3d(draw(3), draw(4), draw(5)).normalized();
  const double phase = 2.0 * std::numbers::pi * CalcUniform({kBiasKey, seed, number, 6});
  const double place = kRadiansPerMetre * over_place.dot(X_WF.translation());
  const double view = kRadiansPerAxis * over_view.dot(X_WF.linear().col(2));
  return phase + place + view;
}

}  // namespace

PoseError::PoseError(double bias_m, double noise_m, uint64_t seed) : bias_m_(bias_m), noise_m_(noise_m), seed_(seed) {}

PoseError PoseError::Make(const RunConfig& config) {
  if (!config.cell.arm) return {0.0, 0.0, config.seed};
  return {config.cell.arm->pose_bias_m, config.cell.arm->pose_noise_m, config.seed};
}

Eigen::Vector3d PoseError::CalcBias(const Pose& X_WF) const {
  const double azimuth = CalcWave(X_WF, seed_, 0);
  const double height = 0.8 * std::sin(CalcWave(X_WF, seed_, 1));
  const double length = bias_m_ * (1.0 + std::sin(CalcWave(X_WF, seed_, 2)) / 3.0);
  const double across = std::sqrt(1.0 - height * height);
  return length * Eigen::Vector3d(across * std::cos(azimuth), across * std::sin(azimuth), height);
}

Pose PoseError::CalcTruePose(const Pose& X_WF, int64_t utime_us) const {
  if (bias_m_ == 0.0 && noise_m_ == 0.0) return X_WF;
  Pose X_WF_true = X_WF;
  X_WF_true.translation() += CalcBias(X_WF);
  for (uint64_t axis = 0; axis < 3; ++axis)
    X_WF_true.translation()[static_cast<Eigen::Index>(axis)] +=
        noise_m_ * CalcGaussian({kNoiseKey, seed_, static_cast<uint64_t>(utime_us), axis});
  return X_WF_true;
}

}  // namespace nbs
