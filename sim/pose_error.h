#pragma once

#include <cstdint>

#include "common/config/run_config.h"

namespace nbs {

/// Where the flange of an arm truly is when the arm says that it is somewhere: an arm repeats a pose well, but its
/// links and joints are not quite what its model says.
///
/// The bias is a smooth function of the pose alone: at the same pose it is the same, over a metre or half a turn it
/// changes its direction by about a radian, and its length stays within a third of the mean. The noise is independent
/// from instant to instant. Both are pure functions of (seed, pose) and (seed, time).
class PoseError {
 public:
  /// @param bias_m   Mean length of the bias, >= 0.
  /// @param noise_m  Standard deviation of the noise on each axis, >= 0.
  PoseError(double bias_m, double noise_m, uint64_t seed);

  /// Of a run's cell; none for a free-flying sensor.
  static PoseError Make(const RunConfig& config);

  /// The true pose of a flange that is reported at X_WF at `utime_us`. Its orientation is as reported.
  Pose CalcTruePose(const Pose& X_WF, int64_t utime_us) const;

  /// The bias at a reported pose, metres in W.
  Eigen::Vector3d CalcBias(const Pose& X_WF) const;

 private:
  double bias_m_;
  double noise_m_;
  uint64_t seed_;
};

}  // namespace nbs
