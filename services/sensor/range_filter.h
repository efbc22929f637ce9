#pragma once

#include <cstdint>
#include <vector>

#include "common/sensing/profiler.h"

namespace nbs {

/// Ranges with only the measurements that count, and how many were set to 0.
struct FilteredRanges {
  std::vector<float> ranges_m;  ///< Along the beam; 0: no return, or dropped.
  int64_t out_of_depth = 0;     ///< The point's depth (z in S) lies outside the depth of field.
  int64_t not_a_range = 0;      ///< Negative or not finite.
};

/// Keeps the ranges whose point lies in the depth of field (ends included) and sets all others to 0. A range of 0 means
/// no return and stays.
///
/// @param profiler      Depth of field.
/// @param directions_S  Unit direction of each beam in the sensor frame.
/// @param ranges_m      One range a beam, metres from the emitter.
/// @throws std::invalid_argument if there are not as many ranges as beams.
FilteredRanges FilterRanges(const Profiler& profiler, const std::vector<Eigen::Vector3d>& directions_S,
                            const std::vector<float>& ranges_m);

}  // namespace nbs
