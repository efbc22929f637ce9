#include "sim/oracle/partners.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/point_grid.h"

namespace nbs {

Partners::Partners(std::span<const SurfaceSample> samples, double max_distance_m, double max_angle_rad)
    : first_(samples.size() + 1, 0) {
  if (!(max_distance_m >= 0.0) || !std::isfinite(max_distance_m)) {
    throw std::invalid_argument("Partners: a distance of " + std::to_string(max_distance_m) + " m");
  }
  if (max_distance_m == 0.0) return;
  const double min_cosine = std::cos(max_angle_rad);
  PointGrid grid(max_distance_m);
  for (size_t i = 0; i < samples.size(); ++i) grid.Insert(samples[i].p_W, static_cast<uint32_t>(i));
  for (size_t i = 0; i < samples.size(); ++i) {
    for (uint32_t j : grid.FindNear(samples[i].p_W)) {
      if (j != i && samples[j].normal_W.dot(samples[i].normal_W) >= min_cosine) numbers_.push_back(j);
    }
    first_[i + 1] = numbers_.size();
  }
}

}  // namespace nbs
