#include "common/mapping/voxel_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/runtime/error.h"

namespace nbs {
namespace {

GridShape MakeShape(int x, int y, int z) { return {Eigen::Vector3d(-0.1, 0.0, 0.05), 0.005, Eigen::Vector3i(x, y, z)}; }

TEST(VoxelGrid, BeginsUnobserved) {
  const VoxelGrid grid(MakeShape(2, 3, 4));
  EXPECT_EQ(grid.cells().size(), 24U);
  for (const int16_t cell : grid.cells()) EXPECT_EQ(cell, kUnobserved);
}

TEST(VoxelGrid, RefusesAShapeWithoutSize) {
  EXPECT_THROW(VoxelGrid(MakeShape(0, 3, 4)), ConfigError);
  EXPECT_THROW(VoxelGrid(MakeShape(2, -3, -4)), ConfigError);
}

TEST(VoxelGrid, RefusesAShapeOverTheMemoryLimit) {
  EXPECT_THROW(VoxelGrid(MakeShape(513, 512, 512)), ConfigError);
  EXPECT_THROW(VoxelGrid(MakeShape(2000000000, 2000000000, 2000000000)), ConfigError);
}

TEST(VoxelGrid, RefusesABadResolutionAndAnOriginBetweenCells) {
  GridShape shape = MakeShape(2, 3, 4);
  shape.resolution_m = 0.0;
  EXPECT_THROW(VoxelGrid{shape}, ConfigError);
  shape.resolution_m = std::nan("");
  EXPECT_THROW(VoxelGrid{shape}, ConfigError);
  shape = MakeShape(2, 3, 4);
  shape.origin_W.y() = 0.002;
  EXPECT_THROW(VoxelGrid{shape}, ConfigError);
}

TEST(VoxelGrid, OccupiedMeansAProbabilityOfAtLeast95Percent) {
  EXPECT_GE(CalcProbability(kOccupiedLogOdds), 0.95);
  EXPECT_LT(CalcProbability(kOccupiedLogOdds - 1), 0.95);
  EXPECT_TRUE(IsOccupied(kOccupiedLogOdds));
  EXPECT_FALSE(IsOccupied(kOccupiedLogOdds - 1));
  EXPECT_FALSE(IsOccupied(kUnobserved));
}

TEST(VoxelGrid, UnobservedHasProbabilityOneHalf) {
  EXPECT_EQ(CalcProbability(kUnobserved), 0.5);
  EXPECT_EQ(CalcProbability(0), 0.5);
}

TEST(VoxelGrid, LogOddsInvertProbability) {
  for (int l = -12000; l <= 12000; l += 7) EXPECT_EQ(CalcLogOdds(CalcProbability(static_cast<int16_t>(l))), l);
  EXPECT_EQ(CalcLogOdds(1e-300), -32767);
  EXPECT_THROW((void)CalcLogOdds(0.0), std::invalid_argument);
  EXPECT_THROW((void)CalcLogOdds(1.0), std::invalid_argument);
  EXPECT_THROW((void)CalcLogOdds(std::nan("")), std::invalid_argument);
}

TEST(EntropyTable, IsTheFormulaOfEquation1ToHalfAUnit) {
  for (int l = -32768; l <= 32767; ++l) {
    const double p = CalcProbability(static_cast<int16_t>(l));
    const double q = 1.0 / (1.0 + std::exp(l == kUnobserved ? 0.0 : l / kLogOddsPerNat));
    const double nats = -p * std::log(p) - q * std::log(q);
    EXPECT_NEAR(EntropyTable()[static_cast<uint16_t>(l)], nats * kEntropyPerNat, 0.51) << l;
  }
}

TEST(EntropyTable, LiesBetweenZeroAndLn2AndIsSymmetric) {
  const auto most = static_cast<uint16_t>(std::lround(std::log(2.0) * kEntropyPerNat));
  EXPECT_EQ(EntropyTable()[static_cast<uint16_t>(kUnobserved)], most);
  EXPECT_EQ(EntropyTable()[0], most);
  for (int l = 1; l <= 32767; ++l) {
    EXPECT_LE(EntropyTable()[l], EntropyTable()[l - 1]);
    EXPECT_EQ(EntropyTable()[l], EntropyTable()[static_cast<uint16_t>(-l)]);
  }
}

TEST(VoxelDelta, CarriesAReplicaAlong) {
  VoxelGrid grid(MakeShape(30, 20, 10)), replica(grid.shape());
  ChangeTracker changes(grid.shape().cells());
  std::mt19937_64 engine(1);
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 300; ++i) {
      const int64_t first = engine() % grid.shape().cells();
      for (int64_t index = first; index < std::min<int64_t>(first + engine() % 9, grid.shape().cells()); ++index) {
        grid.cells()[index] = static_cast<int16_t>(engine() % 1000);
        changes.Mark(index);
      }
    }
    replica.Apply(changes.TakeDelta(grid));
    ASSERT_EQ(grid, replica);
  }
}

TEST(VoxelDelta, IsEmptyWhenNothingChanged) {
  VoxelGrid grid(MakeShape(3, 3, 3));
  ChangeTracker changes(27);
  changes.Mark(4);
  EXPECT_EQ(changes.TakeDelta(grid).values.size(), 1U);
  EXPECT_EQ(changes.TakeDelta(grid), VoxelDelta{});
}

TEST(VoxelDelta, JoinsNeighboursToRunsAndNamesEachCellOnce) {
  VoxelGrid grid(MakeShape(10, 10, 10));
  ChangeTracker changes(1000);
  for (const int64_t index : {700, 64, 63, 65, 10, 64}) {
    grid.cells()[index] = static_cast<int16_t>(index);
    changes.Mark(index);
  }
  const VoxelDelta delta = changes.TakeDelta(grid);
  EXPECT_EQ(delta.run_start, (std::vector<uint32_t>{10, 63, 700}));
  EXPECT_EQ(delta.run_length, (std::vector<uint16_t>{1, 3, 1}));
  EXPECT_EQ(delta.values, (std::vector<int16_t>{10, 63, 64, 65, 700}));
}

TEST(VoxelDelta, CutsRunsThatAreTooLongForTheirLength) {
  VoxelGrid grid(MakeShape(100, 100, 10)), replica(grid.shape());
  ChangeTracker changes(100000);
  for (int64_t index = 0; index < 100000; ++index) changes.Mark(index);
  grid.cells()[70000] = 5;
  const VoxelDelta delta = changes.TakeDelta(grid);
  EXPECT_EQ(delta.run_length, (std::vector<uint16_t>{65535, 34465}));
  replica.Apply(delta);
  EXPECT_EQ(replica, grid);
}

TEST(VoxelDelta, WithBadRunsIsRefusedAndChangesNothing) {
  const VoxelGrid before(MakeShape(3, 3, 3));
  const auto delta = [](std::vector<uint32_t> start, std::vector<uint16_t> length, size_t values) {
    VoxelDelta made;
    made.run_start = std::move(start);
    made.run_length = std::move(length);
    made.values.assign(values, 7);
    return made;
  };
  for (const VoxelDelta& bad :
       {delta({26}, {2}, 2), delta({3, 4}, {2, 1}, 3), delta({5, 2}, {1, 1}, 2), delta({1}, {0}, 0), delta({1}, {2}, 3),
        delta({1, 2}, {1}, 1), delta({4294967295}, {1}, 1)}) {
    VoxelGrid grid = before;
    EXPECT_THROW(grid.Apply(bad), std::invalid_argument);
    EXPECT_EQ(grid, before);
  }
}

}  // namespace
}  // namespace nbs
