#include "sim/point_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

TEST(PointGrid, FindsThoseOfBruteForce) {
  std::vector<Eigen::Vector3d> points;
  PointGrid grid(0.1);
  for (uint64_t i = 0; i < 500; ++i) {
    points.emplace_back(CalcUniform({i, 0}) - 0.5, CalcUniform({i, 1}) - 0.5, CalcUniform({i, 2}) - 0.5);
    grid.Insert(points.back(), static_cast<uint32_t>(i));
  }
  for (const Eigen::Vector3d& place : points) {
    std::vector<uint32_t> expected;
    for (uint32_t i = 0; i < points.size(); ++i) {
      if ((points[i] - place).norm() <= 0.1) expected.push_back(i);
    }
    EXPECT_THAT(grid.FindNear(place), ::testing::ElementsAreArray(expected));
  }
}

TEST(PointGrid, NeedsAnEdge) {
  EXPECT_THAT([] { PointGrid(0.0); }, ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
