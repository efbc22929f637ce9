#include "services/sensor/range_filter.h"

#include <gtest/gtest.h>

#include <limits>

namespace nbs {
namespace {

Profiler MakeThreeBeams() {
  Profiler profiler;
  profiler.points = 3;
  return profiler;
}

const Profiler kProfiler = MakeThreeBeams();
const std::vector<Eigen::Vector3d> kDirections_S = CalcBeamDirections_S(kProfiler);

TEST(RangeFilter, RangesInTheDepthOfFieldPassUnchanged) {
  const std::vector<float> ranges_m = {0.2f, 0.3f, 0.4f};
  const FilteredRanges filtered = FilterRanges(kProfiler, kDirections_S, ranges_m);
  EXPECT_EQ(filtered.ranges_m, ranges_m);
  EXPECT_EQ(filtered.out_of_depth + filtered.not_a_range, 0);
}

TEST(RangeFilter, RangesOutOfTheDepthOfFieldBecomeZeroAndAreCounted) {
  const FilteredRanges filtered = FilterRanges(kProfiler, kDirections_S, {0.3f, 0.1f, 0.6f});
  EXPECT_EQ(filtered.ranges_m, (std::vector<float>{0.3f, 0.0f, 0.0f}));
  EXPECT_EQ(filtered.out_of_depth, 2);
}

TEST(RangeFilter, TheDepthCountsAndNotTheRange) {
  // The outer beams lie 25 degrees off the axis: a range of 0.54 m ends at a depth of 0.489 m, one of 0.16 m at 0.145
  // m.
  const FilteredRanges filtered = FilterRanges(kProfiler, kDirections_S, {0.54f, 0.54f, 0.16f});
  EXPECT_EQ(filtered.ranges_m, (std::vector<float>{0.54f, 0.0f, 0.0f}));
}

TEST(RangeFilter, NoReturnStaysAndIsNotCounted) {
  const FilteredRanges filtered = FilterRanges(kProfiler, kDirections_S, {0.0f, 0.0f, 0.3f});
  EXPECT_EQ(filtered.ranges_m, (std::vector<float>{0.0f, 0.0f, 0.3f}));
  EXPECT_EQ(filtered.out_of_depth + filtered.not_a_range, 0);
}

TEST(RangeFilter, NegativeAndNotFiniteRangesBecomeZeroAndAreCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const FilteredRanges filtered = FilterRanges(kProfiler, kDirections_S, {nan, -0.3f, infinity});
  EXPECT_EQ(filtered.ranges_m, (std::vector<float>{0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(filtered.not_a_range, 3);
}

TEST(RangeFilter, AnotherNumberOfRangesThanBeamsThrows) {
  EXPECT_THROW(FilterRanges(kProfiler, kDirections_S, {0.3f, 0.3f}), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
