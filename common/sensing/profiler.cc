#include "common/sensing/profiler.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {

Eigen::Vector3d CalcBeamDirection_S(const Profiler& profiler, int i) {
  if (i < 0 || i >= profiler.points) throw std::invalid_argument("CalcBeamDirection_S: no beam " + std::to_string(i));
  const double angle = profiler.fan_rad * (static_cast<double>(i) / (profiler.points - 1) - 0.5);
  return {std::sin(angle), 0.0, std::cos(angle)};
}

std::vector<Eigen::Vector3d> CalcBeamDirections_S(const Profiler& profiler) {
  std::vector<Eigen::Vector3d> directions_S;
  directions_S.reserve(profiler.points);
  for (int i = 0; i < profiler.points; ++i) directions_S.push_back(CalcBeamDirection_S(profiler, i));
  return directions_S;
}

Eigen::Vector3d CalcCamera_S(const Profiler& profiler) { return {0.0, profiler.camera_baseline_m, 0.0}; }

double CalcRangeSigma(const Profiler& profiler, double depth_m) {
  return profiler.sigma_base_m + profiler.sigma_per_m * depth_m * depth_m;
}

}  // namespace nbs
