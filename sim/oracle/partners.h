#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/surface_samples.h"

namespace nbs {

/// For each sample the others that it would be a partner of: samples within max_distance_m whose normals agree within
/// max_angle_rad (the definition of sim/coverage.h, between samples).
class Partners {
 public:
  /// @throws std::invalid_argument if max_distance_m is negative or not finite. With 0 no sample has a partner.
  Partners(std::span<const SurfaceSample> samples, double max_distance_m, double max_angle_rad);

  /// Numbers of the partners of sample i, rising, without i itself.
  std::span<const uint32_t> of(size_t i) const { return {numbers_.data() + first_[i], first_[i + 1] - first_[i]}; }

 private:
  std::vector<size_t> first_;  ///< Where the partners of each sample begin in numbers_, and the end.
  std::vector<uint32_t> numbers_;
};

}  // namespace nbs
