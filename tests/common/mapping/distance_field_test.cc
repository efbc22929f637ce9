#include "common/mapping/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace nbs {
namespace {

constexpr double kResolution = 0.005;
constexpr int16_t kFree = -5000;
constexpr int16_t kOccupied = 5000;

VoxelGrid MakeFreeGrid(int x, int y, int z) {
  VoxelGrid grid({Eigen::Vector3d(-0.1, 0.05, 0.0), kResolution, Eigen::Vector3i(x, y, z)});
  std::ranges::fill(grid.cells(), kFree);
  return grid;
}

/// Distance to the nearest cell that is an obstacle, by trying all.
template <typename Rule>
double CalcTrueDistance(const VoxelGrid& grid, const Eigen::Vector3d& p_W, Rule is_obstacle) {
  double nearest = 1e9;
  const GridShape& shape = grid.shape();
  for (int z = 0; z < shape.size.z(); ++z) {
    for (int y = 0; y < shape.size.y(); ++y) {
      for (int x = 0; x < shape.size.x(); ++x) {
        if (!is_obstacle(grid.At(x, y, z))) continue;
        const Eigen::Vector3d low = shape.origin_W + Eigen::Vector3d(x, y, z) * kResolution;
        const Eigen::Vector3d inside = p_W.cwiseMax(low).cwiseMin(low + Eigen::Vector3d::Constant(kResolution));
        nearest = std::min(nearest, (p_W - inside).norm());
      }
    }
  }
  return nearest;
}

Eigen::Vector3d MakePointAround(const VoxelGrid& grid, double margin, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const Eigen::Vector3d low = grid.shape().origin_W.array() - margin;
  const Eigen::Vector3d extent = (grid.shape().size.cast<double>() * kResolution).array() + 2.0 * margin;
  return low + extent.cwiseProduct(Eigen::Vector3d(uniform(engine), uniform(engine), uniform(engine)));
}

TEST(DistanceField, IsNeverLargerThanTheTrueDistanceAndLittleBelowIt) {
  for (const int cells_per_block : {1, 2, 3}) {
    VoxelGrid grid = MakeFreeGrid(21, 18, 25);
    std::mt19937_64 engine(7);
    for (int i = 0; i < 12; ++i) grid.cells()[engine() % grid.cells().size()] = kOccupied;
    for (int i = 0; i < 12; ++i) grid.cells()[engine() % grid.cells().size()] = kUnobserved;
    DistanceFieldSettings settings;
    settings.cells_per_block = cells_per_block;
    settings.max_distance_m = 0.12;
    const DistanceField to_occupied(grid, Obstacles::kOccupied, settings),
        to_both(grid, Obstacles::kOccupiedOrUnknown, settings);
    for (int i = 0; i < 1500; ++i) {
      const Eigen::Vector3d p_W = MakePointAround(grid, 0.15, engine);
      const double occupied = std::min(0.12, CalcTrueDistance(grid, p_W, IsOccupied));
      const double both = std::min(0.12, CalcTrueDistance(grid, p_W, [](int16_t l) { return l != kFree; }));
      const double slack = 2.5 * cells_per_block * kResolution;
      EXPECT_LE(to_occupied.CalcDistance(p_W), occupied + 1e-9);
      EXPECT_GE(to_occupied.CalcDistance(p_W), occupied - slack);
      EXPECT_LE(to_both.CalcDistance(p_W), both + 1e-9);
      EXPECT_GE(to_both.CalcDistance(p_W), both - slack);
    }
  }
}

TEST(DistanceField, OfSolidBodiesIsExactToTheBlock) {
  VoxelGrid grid = MakeFreeGrid(21, 18, 25);
  const GridShape& shape = grid.shape();
  for (int z = 0; z < 25; ++z) {
    for (int y = 0; y < 18; ++y) {
      for (int x = 0; x < 21; ++x) {
        const bool box = x >= 3 && x < 11 && y >= 5 && y < 14 && z >= 2 && z < 15 && !(y == 9 && z > 8);
        const bool ball = (Eigen::Vector3d(x, y, z) - Eigen::Vector3d(15, 9, 19)).norm() < 5.0;
        if (box || ball) grid.cells()[shape.Index(x, y, z)] = ball ? kOccupied : kUnobserved;
      }
    }
  }
  DistanceFieldSettings settings;
  settings.cells_per_block = 1;
  settings.max_distance_m = 0.12;
  const DistanceField field(grid, Obstacles::kOccupiedOrUnknown, settings);
  std::mt19937_64 engine(9);
  for (int i = 0; i < 1500; ++i) {
    // At a block's centre nothing is interpolated, and the field's distance is that from centre to surface.
    Eigen::Vector3d p_W = MakePointAround(grid, 0.1, engine);
    p_W = ((p_W / kResolution).array().floor() + 0.5) * kResolution;
    const double expected = std::min(0.12, CalcTrueDistance(grid, p_W, [](int16_t l) { return l != kFree; }));
    EXPECT_NEAR(field.CalcDistance(p_W), expected, 1e-6);
  }
}

TEST(DistanceField, OfAFreeGridIsTheCutOffEverywhere) {
  const DistanceField field(MakeFreeGrid(20, 20, 20), Obstacles::kOccupiedOrUnknown);
  std::mt19937_64 engine(8);
  for (int i = 0; i < 200; ++i)
    EXPECT_EQ(field.CalcDistance(MakePointAround(MakeFreeGrid(20, 20, 20), 0.5, engine)), 0.3);
}

TEST(DistanceField, OnlyTellsUnknownFromObstacleWhenAsked) {
  VoxelGrid grid = MakeFreeGrid(20, 20, 20);
  grid.cells()[grid.shape().Index(10, 10, 10)] = kUnobserved;
  const Eigen::Vector3d p_W = grid.shape().origin_W + Eigen::Vector3d::Constant(10.5 * kResolution);
  EXPECT_EQ(DistanceField(grid, Obstacles::kOccupied).CalcDistance(p_W), 0.3);
  EXPECT_EQ(DistanceField(grid, Obstacles::kOccupiedOrUnknown).CalcDistance(p_W), 0.0);
}

TEST(DistanceField, TakesCellsBetweenFreeAndOccupiedAsUnknown) {
  const auto distance_at = [](double probability, Obstacles obstacles) {
    VoxelGrid grid = MakeFreeGrid(3, 3, 3);
    std::ranges::fill(grid.cells(), CalcLogOdds(probability));
    return DistanceField(grid, obstacles).CalcDistance(grid.shape().origin_W + Eigen::Vector3d::Constant(0.0075));
  };
  EXPECT_EQ(distance_at(0.29, Obstacles::kOccupiedOrUnknown), 0.3);
  EXPECT_EQ(distance_at(0.31, Obstacles::kOccupiedOrUnknown), 0.0);
  EXPECT_EQ(distance_at(0.94, Obstacles::kOccupied), 0.3);
  EXPECT_EQ(distance_at(0.951, Obstacles::kOccupied), 0.0);
}

TEST(DistanceField, ReachesOutOfTheGrid) {
  const VoxelGrid unknown({Eigen::Vector3d::Zero(), kResolution, Eigen::Vector3i(40, 40, 40)});
  const DistanceField field(unknown, Obstacles::kOccupiedOrUnknown);
  for (const double out : {0.02, 0.05, 0.15, 0.28}) {
    const double distance = field.CalcDistance(Eigen::Vector3d(-out, 0.1, 0.1));
    EXPECT_LE(distance, out);
    EXPECT_GE(distance, out - 0.002);
  }
  EXPECT_EQ(field.CalcDistance(Eigen::Vector3d(-0.32, 0.1, 0.1)), 0.3);
}

TEST(DistanceField, RefusesBadSettings) {
  const VoxelGrid grid = MakeFreeGrid(3, 3, 3);
  for (const DistanceFieldSettings& bad :
       {DistanceFieldSettings{0, 0.3, 0.3}, DistanceFieldSettings{2, 0.0, 0.3}, DistanceFieldSettings{2, 0.61, 0.3},
        DistanceFieldSettings{2, 0.3, 0.95}, DistanceFieldSettings{2, 0.3, 0.0}}) {
    EXPECT_THROW(DistanceField(grid, Obstacles::kOccupied, bad), std::invalid_argument);
  }
}

}  // namespace
}  // namespace nbs
