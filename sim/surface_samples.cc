#include "sim/surface_samples.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr uint64_t kPlacementKey = 0x636f766572616765;  // "coverage"

}  // namespace

std::vector<SurfaceSample> MakeSurfaceSamples(const TriangleMesh& truth_W, int count) {
  if (count < 1) throw std::invalid_argument("MakeSurfaceSamples: " + std::to_string(count) + " samples");
  const auto corner = [&truth_W](size_t t, int i) -> Vector3d {
    return truth_W.vertices_W[truth_W.triangles[t][i]].cast<double>();
  };
  std::vector<double> area_up_to;
  double area = 0.0;
  for (size_t t = 0; t < truth_W.triangles.size(); ++t) {
    area += 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
    area_up_to.push_back(area);
  }
  if (!(area > 0.0)) throw std::invalid_argument("MakeSurfaceSamples: the surface has no area");
  std::vector<SurfaceSample> samples;
  samples.reserve(count);
  size_t t = 0;
  for (int i = 0; i < count; ++i) {
    const double target = (i + 0.5) / count * area;
    while (area_up_to[t] < target) ++t;
    const double root = std::sqrt(CalcUniform({kPlacementKey, static_cast<uint64_t>(i), 0}));
    const double v = CalcUniform({kPlacementKey, static_cast<uint64_t>(i), 1});
    const Vector3d a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Vector3d p = (1.0 - root) * a + root * (1.0 - v) * b + root * v * c;
    samples.push_back({p, (b - a).cross(c - a).normalized()});
  }
  return samples;
}

}  // namespace nbs
