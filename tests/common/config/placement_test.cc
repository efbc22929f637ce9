#include <gtest/gtest.h>

#include <cmath>

#include "common/config/run_config.h"
#include "tests/common/config/config_testing.h"

namespace nbs {
namespace {

const Eigen::AlignedBox3d kBox_W(Eigen::Vector3d(-0.101, -0.2, 0.003), Eigen::Vector3d(0.1, 0.202, 0.5));

RunConfig Resolve(const CellConfig& cell) {
  RunConfig config;
  config.cell = cell;
  ResolvePlacement(kBox_W, config);
  return config;
}

TEST(Placement, GridHoldsTheBoxAndItsMarginAndNoVoxelMore) {
  const GridShape grid = Resolve({}).grid;
  const Eigen::Vector3d top_W = grid.origin_W + grid.resolution_m * grid.size.cast<double>();
  for (int axis = 0; axis < 3; ++axis) {
    const double below = kBox_W.min()[axis] - 0.05 - grid.origin_W[axis];
    const double above = top_W[axis] - (kBox_W.max()[axis] + 0.05);
    EXPECT_GE(below, -1e-8);
    EXPECT_LT(below, 0.005);
    EXPECT_GE(above, -1e-8);
    EXPECT_LT(above, 0.005);
  }
}

TEST(Placement, GridOriginIsAMultipleOfTheResolution) {
  const GridShape grid = Resolve({}).grid;
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(grid.origin_W[axis], std::round(grid.origin_W[axis] / 0.005) * 0.005);
}

TEST(Placement, BoxThatEndsOnAVoxelGetsNoFurtherLayer) {
  RunConfig config;
  ResolvePlacement({Eigen::Vector3d(-0.1, -0.1, -0.1), Eigen::Vector3d(0.1, 0.1, 0.1)}, config);
  EXPECT_EQ(config.grid.size, Eigen::Vector3i(60, 60, 60));
}

TEST(Placement, FirstPathStandsItsDistanceBeforeTheFaceAndLooksAtTheMiddle) {
  const RunConfig config = Resolve({});
  const Eigen::Vector3d half = 0.5 * config.grid.resolution_m * config.grid.size.cast<double>();
  const Eigen::Vector3d middle_W = config.grid.origin_W + half;
  const Pose X_WS = Interpolate(config.first_path.X_WS_start, config.first_path.X_WS_end, 0.5);
  EXPECT_NEAR(X_WS.translation().y(), config.grid.origin_W.y() - 0.2, 1e-12);
  EXPECT_TRUE((X_WS.linear().col(2)).isApprox((middle_W - X_WS.translation()).normalized(), 1e-9));
}

TEST(Placement, FirstPathRunsOverTheWholeExtent) {
  const RunConfig config = Resolve({});
  EXPECT_NEAR(config.first_path.X_WS_start.translation().z(), config.grid.origin_W.z(), 1e-12);
  EXPECT_NEAR(config.first_path.length_m(), config.grid.resolution_m * config.grid.size.z(), 1e-12);
}

TEST(Placement, TableGoesWithTheObjectAndNothingBelowItIsUnknown) {
  CellConfig cell;
  cell.table_above_object_m = -0.01;
  cell.first_along_W = {0, 0, 1};
  cell.first_above_table_m = 0.1;
  const RunConfig config = Resolve(cell);
  EXPECT_NEAR(*config.cell.table_z_m, kBox_W.min().z() - 0.01, 1e-12);
  EXPECT_LE(config.grid.origin_W.z(), *config.cell.table_z_m);
  EXPECT_GT(config.grid.origin_W.z(), *config.cell.table_z_m - 0.005);
  EXPECT_NEAR(config.first_path.X_WS_start.translation().z(), *config.cell.table_z_m + 0.1, 1e-12);
  EXPECT_GT(config.first_path.X_WS_end.translation().z(), kBox_W.max().z());
}

// A box so high on a table, with a path upwards that stays 150 mm above the table.
RunConfig ResolveOnTable(double height_m) {
  RunConfig config;
  config.cell.table_above_object_m = 0.0;
  config.cell.first_view_W = {1, 0, 0};
  config.cell.first_above_table_m = 0.15;
  ResolvePlacement({Eigen::Vector3d(-0.06, -0.06, 0.0), Eigen::Vector3d(0.06, 0.06, height_m)}, config);
  return config;
}

TEST(Placement, FirstPathLooksDownAtAnObjectTooLowToBeSeenFromTheSide) {
  for (const double height_m : {0.03, 0.08, 0.12, 0.3}) {
    const RunConfig config = ResolveOnTable(height_m);
    const ScanPath& path = config.first_path;
    const Eigen::Vector3d half = 0.5 * config.grid.resolution_m * config.grid.size.cast<double>();
    const Eigen::Vector3d view_W = path.X_WS_start.linear().col(2), along_W = path.X_WS_start.linear().col(1);
    const double extent_m = 2.0 * half.dot(along_W.cwiseAbs());
    EXPECT_LT(view_W.z(), -0.01);
    EXPECT_NEAR(view_W.y(), 0.0, 1e-12);
    EXPECT_GE(path.length_m(), 0.7 * extent_m);
    EXPECT_GE(path.X_WS_start.translation().z(), 0.15 - 1e-9);
    // In the plane of the path and the view lies the box's middle, at a depth at which its face stands off by 0.2 m.
    const Eigen::Vector3d to_middle_W = config.grid.origin_W + half - path.X_WS_end.translation();
    EXPECT_NEAR(to_middle_W.dot(view_W.cross(along_W)), 0.0, 1e-9);
    EXPECT_NEAR(to_middle_W.dot(view_W), 0.2 + half.dot(view_W.cwiseAbs()), 1e-9);
  }
}

TEST(Placement, FirstPathLooksLevelAtAnObjectThatIsHighEnough) {
  const ScanPath path = ResolveOnTable(0.5).first_path;
  EXPECT_EQ(path.X_WS_start.linear().col(2), Eigen::Vector3d::UnitX());
  EXPECT_NEAR(path.length_m(), 0.4, 1e-9);
}

TEST(Placement, BaseStandsRelativeToTheMiddleOfTheObjectsBottom) {
  CellConfig cell;
  cell.arm.emplace().X_OB.translation() = Eigen::Vector3d(-1.0, 0.1, -0.3);
  const RunConfig config = Resolve(cell);
  const Eigen::Vector3d expected =
      Eigen::Vector3d(kBox_W.center().x(), kBox_W.center().y(), kBox_W.min().z()) + cell.arm->X_OB.translation();
  EXPECT_LT((CalcBasePose(config).translation() - expected).norm(), 1e-12);
}

TEST(Placement, ScanDirectionIsTheSensorsYAxis) {
  CellConfig cell;
  cell.first_view_W = {-3, 0, -1};
  cell.first_along_W = {0, 2, 0};
  const ScanPath path = Resolve(cell).first_path;
  const Eigen::Vector3d along_W = (path.X_WS_end.translation() - path.X_WS_start.translation()).normalized();
  EXPECT_TRUE(along_W.isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(path.X_WS_start.linear().col(1).isApprox(along_W, 1e-12));
  EXPECT_TRUE(path.X_WS_start.linear().isApprox(path.X_WS_end.linear(), 1e-12));
}

TEST(Placement, ObjectInMillimetresIsRefused) {
  RunConfig config;
  const std::string error = CatchConfigError([&] {
    ResolvePlacement({Eigen::Vector3d::Zero(), Eigen::Vector3d(200, 300, 500)}, config);
  });
  EXPECT_NE(error.find("is the object's unit metres"), std::string::npos) << error;
}

TEST(Placement, EmptyBoxIsRefused) {
  RunConfig config;
  EXPECT_EQ(CatchConfigError([&] { ResolvePlacement(Eigen::AlignedBox3d(), config); }),
            "the object's bounding box is empty or not finite");
}

}  // namespace
}  // namespace nbs
