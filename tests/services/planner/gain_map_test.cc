#include "services/planner/gain_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

constexpr int kSize = 20;

VoxelGrid MakeGrid() { return VoxelGrid({Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i::Constant(kSize)}); }

TEST(GainMap, UnderTheSumRuleACellIsWorthItsEntropy) {
  VoxelGrid grid = MakeGrid();
  grid.cells()[3] = -2000;
  grid.cells()[4] = 8000;
  const GainMap map(grid);
  EXPECT_EQ(map.values()[0], EntropyTable()[static_cast<uint16_t>(kUnobserved)]);
  EXPECT_EQ(map.values()[3], EntropyTable()[static_cast<uint16_t>(int16_t{-2000})]);
  EXPECT_EQ(map.values()[4], GainMap::kWall);
}

TEST(GainMap, NearSurfaceCountsExactlyTheCellsWithinReachOfAWall) {
  VoxelGrid grid = MakeGrid();
  const GridShape& shape = grid.shape();
  std::vector<Eigen::Vector3i> walls;
  for (uint64_t i = 0; i < 12; ++i) {
    Eigen::Vector3i wall;
    for (uint64_t axis = 0; axis < 3; ++axis) wall[axis] = static_cast<int>(kSize * CalcUniform({7, i, axis}));
    walls.push_back(wall);
    grid.cells()[shape.Index(wall.x(), wall.y(), wall.z())] = 8000;
  }
  constexpr double kReach_m = 0.0225;  // 4.5 cells
  const GainMap map(grid, GainRule::kNearSurface, kReach_m);
  for (int z = 0; z < kSize; ++z) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const uint16_t value = map.values()[shape.Index(x, y, z)];
        if (value == GainMap::kWall) continue;
        bool is_near = false;
        for (const auto& wall : walls)
          is_near |= 0.005 * (wall - Eigen::Vector3i(x, y, z)).cast<double>().norm() <= kReach_m;
        EXPECT_EQ(value != 0, is_near) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(GainMap, WithoutAnyWallNearSurfaceIsTheSum) {
  const VoxelGrid grid = MakeGrid();
  EXPECT_TRUE(std::ranges::equal(GainMap(grid, GainRule::kNearSurface).values(), GainMap(grid).values()));
}

TEST(GainMap, UnderTheUnknownCountCellsBetweenFreeAndOccupiedAreGoals) {
  VoxelGrid grid = MakeGrid();
  grid.cells()[1] = CalcLogOdds(0.29);
  grid.cells()[2] = CalcLogOdds(0.31);
  grid.cells()[3] = CalcLogOdds(0.94);
  grid.cells()[4] = CalcLogOdds(0.951);
  const GainMap map(grid, GainRule::kUnknownCount);
  EXPECT_EQ(map.values()[0], GainMap::kGoal);
  EXPECT_EQ(map.values()[1], 0);
  EXPECT_EQ(map.values()[2], GainMap::kGoal);
  EXPECT_EQ(map.values()[3], GainMap::kGoal);
  EXPECT_EQ(map.values()[4], GainMap::kWall);
}

TEST(GainMap, MeanAndPerSecondWeighTheMapOfTheSum) {
  VoxelGrid grid = MakeGrid();
  grid.cells()[3] = -2000;
  grid.cells()[4] = 8000;
  for (const GainRule rule : {GainRule::kMean, GainRule::kPerSecond})
    EXPECT_TRUE(std::ranges::equal(GainMap(grid, rule).values(), GainMap(grid).values()));
}

TEST(GainMap, NoEntropyIsTakenForAWallOrAGoal) {
  EXPECT_LT(std::ranges::max(EntropyTable()), std::min(GainMap::kWall, GainMap::kGoal));
}

TEST(GainMap, AReachThatIsNegativeOrNotFiniteIsRefused) {
  const VoxelGrid grid = MakeGrid();
  EXPECT_THROW(GainMap(grid, GainRule::kNearSurface, -0.01), std::invalid_argument);
  EXPECT_THROW(GainMap(grid, GainRule::kNearSurface, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
