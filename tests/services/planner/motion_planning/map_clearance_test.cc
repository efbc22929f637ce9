#include "services/planner/motion_planning/map_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "services/planner/motion_planning/collision_body.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "services/planner/motion_planning/swept_check.h"
#include "tests/services/planner/motion_planning/map_cases.h"
#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

/// Distance to the nearest cell that is not free, at most `reach_m`, by looking at all cells within it.
double CalcTrueDistance(const VoxelGrid& grid, const Eigen::Vector3d& p_W, bool unknown_too, double reach_m) {
  const GridShape& shape = grid.shape();
  const Eigen::Array3d cell = (p_W - shape.origin_W).array() / shape.resolution_m;
  const double reach = reach_m / shape.resolution_m;
  const Eigen::Array3i low = (cell - reach).floor().max(0.0).cast<int>();
  const Eigen::Array3i high = (cell + reach).ceil().cast<int>().min(shape.size.array());
  double distance = reach_m;
  for (int z = low.z(); z < high.z(); ++z) {
    for (int y = low.y(); y < high.y(); ++y) {
      for (int x = low.x(); x < high.x(); ++x) {
        const int16_t log_odds = grid.At(x, y, z);
        if (!IsOccupied(log_odds) && !(unknown_too && log_odds == kUnobserved)) continue;
        const Eigen::Vector3d low_W = shape.origin_W + shape.resolution_m * Eigen::Vector3d(x, y, z);
        const Eigen::AlignedBox3d box(low_W, (low_W.array() + shape.resolution_m).matrix());
        distance = std::min(distance, box.exteriorDistance(p_W));
      }
    }
  }
  return distance;
}

TEST(MapClearance, NeitherDistanceExceedsTheTrueOne) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  const MapClearance clearance(grid);
  for (uint64_t k = 0; k < 40; ++k) {
    const Eigen::Vector3d p_W = MakeRandomPose(11, k, 0.4).translation();
    EXPECT_LE(clearance.CalcObstacleDistance(p_W), CalcTrueDistance(grid, p_W, false, 1.0) + 1e-9);
    EXPECT_LE(clearance.CalcUnknownDistance(p_W), CalcTrueDistance(grid, p_W, true, 1.0) + 1e-9);
    EXPECT_LE(clearance.CalcUnknownDistance(p_W), clearance.CalcObstacleDistance(p_W) + 1e-9);
  }
}

TEST(MapClearance, ReachesAsFarInAFinerGrid) {
  for (const double resolution_m : {0.005, 0.00125, 0.0005}) {
    VoxelGrid grid({Eigen::Vector3d::Zero(), resolution_m, Eigen::Vector3i(8, 8, 8)});
    std::ranges::fill(grid.cells(), CalcLogOdds(0.99));
    const MapClearance clearance(grid);
    EXPECT_NEAR(clearance.CalcObstacleDistance({-0.2, 0.0, 0.0}), 0.2, 0.025);
    EXPECT_LE(clearance.CalcObstacleDistance({-0.2, 0.0, 0.0}), 0.2);
  }
}

TEST(MapClearance, TellsOccupiedFromUnknown) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  const MapClearance clearance(grid);
  EXPECT_GT(clearance.CalcObstacleDistance({-0.14, 0, 0}), 0.1);
  EXPECT_EQ(clearance.CalcUnknownDistance({-0.14, 0, 0}), 0.0);
  EXPECT_EQ(clearance.CalcObstacleDistance({0.1, 0, 0}), 0.0);
}

TEST(MapClearance, TheSeenSideIsReachableAndTheUnseenIsNotYet) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  const MapClearance clearance(grid);
  const MotionPlanner planner(MakeRunAround(grid));
  const auto check = [&](double x) {
    const Eigen::Vector3d view_W(x > 0 ? -1.0 : 1.0, 0, 0);
    const Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
    const ScanPath path = {MakeLookPose({x, 0, -0.1}, view_W, up_W), MakeLookPose({x, 0, 0.1}, view_W, up_W)};
    return planner.CheckPath(clearance, path).verdict;
  };
  EXPECT_EQ(check(0.16), Verdict::kReachable);
  EXPECT_EQ(check(0.09), Verdict::kBlockedByObstacle);
  EXPECT_EQ(check(-0.14), Verdict::kBlockedByUnknown);
}

/// The swept check on the map's field, against the map's cells themselves.
class MapMotion : public testing::TestWithParam<uint64_t> {};

TEST_P(MapMotion, EveryStateKeepsTheMarginToTheCells) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  const MapClearance clearance(grid);
  const CollisionBody body(MakeDefaultSensorBody(), 0.02);
  const Pose X_now = MakeUpwardPath(6.28 * CalcUniform({GetParam(), 1})).X_WS_start;
  const ScanPath path = MakeUpwardPath(6.28 * CalcUniform({GetParam(), 2}));
  const MotionPlanner::Result result = MotionPlanner(MakeRunAround(grid)).Plan(clearance, X_now, path, GetParam());
  ASSERT_TRUE(result.found());
  const auto& points = result.trajectory.points;
  double slack = 1.0;
  for (size_t k = 0; k + 1 < points.size(); ++k) {
    for (int step = 0; step <= 20; ++step) {
      const Pose X_WF = Interpolate(points[k].X_WF, points[k + 1].X_WF, step / 20.0);
      for (const Sphere& sphere : body.spheres_B()) {
        const double distance = CalcTrueDistance(grid, X_WF * sphere.center, true, 0.1);
        slack = std::min(slack, distance - sphere.radius_m - body.margin_m());
      }
    }
  }
  EXPECT_GE(slack, -kSweepTolerance / 2.0);
}

INSTANTIATE_TEST_SUITE_P(RandomRequests, MapMotion, testing::Range<uint64_t>(1, 13));

}  // namespace
}  // namespace nbs
