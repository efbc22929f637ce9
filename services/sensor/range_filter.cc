#include "services/sensor/range_filter.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {

FilteredRanges FilterRanges(const Profiler& profiler, const std::vector<Eigen::Vector3d>& directions_S,
                            const std::vector<float>& ranges_m) {
  if (ranges_m.size() != directions_S.size()) {
    throw std::invalid_argument("FilterRanges: " + std::to_string(ranges_m.size()) + " ranges for " +
                                std::to_string(directions_S.size()) + " beams");
  }
  FilteredRanges filtered;
  filtered.ranges_m = ranges_m;
  for (size_t i = 0; i < ranges_m.size(); ++i) {
    float& range = filtered.ranges_m[i];
    if (range == 0.0f) continue;
    if (!std::isfinite(range) || range < 0.0f) {
      ++filtered.not_a_range;
      range = 0.0f;
      continue;
    }
    const double depth_m = static_cast<double>(range) * directions_S[i].z();
    if (depth_m >= profiler.min_depth_m && depth_m <= profiler.max_depth_m) continue;
    ++filtered.out_of_depth;
    range = 0.0f;
  }
  return filtered;
}

}  // namespace nbs
