#include "common/geometry/directions.h"

#include <cmath>
#include <numbers>

namespace nbs {

std::vector<Eigen::Vector3d> MakeSphereDirections(int count) {
  constexpr double kGoldenAngle = std::numbers::pi * (3.0 - 2.2360679774997896);
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(count);
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double radius = std::sqrt(1.0 - z * z);
    directions.emplace_back(radius * std::cos(i * kGoldenAngle), radius * std::sin(i * kGoldenAngle), z);
  }
  return directions;
}

}  // namespace nbs
