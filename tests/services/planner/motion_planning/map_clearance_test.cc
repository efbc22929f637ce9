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

/// Distance to the nearest cell that is not free, by looking at all of them.
double CalcTrueDistance(const VoxelGrid& grid, const Eigen::Vector3d& p_W, bool unknown_too) {
  const GridShape& shape = grid.shape();
  double distance = 0.3;
  for (int z = 0; z < shape.size.z(); ++z) {
    for (int y = 0; y < shape.size.y(); ++y) {
      for (int x = 0; x < shape.size.x(); ++x) {
        const int16_t log_odds = grid.At(x, y, z);
        if (!IsOccupied(log_odds) && !(unknown_too && log_odds == kUnobserved)) continue;
        const Eigen::Vector3d low_W = shape.origin_W + shape.resolution_m * Eigen::Vector3d(x, y, z);
        const Eigen::AlignedBox3d cell(low_W, (low_W.array() + shape.resolution_m).matrix());
        distance = std::min(distance, cell.exteriorDistance(p_W));
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
    EXPECT_LE(clearance.CalcObstacleDistance(p_W), CalcTrueDistance(grid, p_W, false) + 1e-9);
    EXPECT_LE(clearance.CalcUnknownDistance(p_W), CalcTrueDistance(grid, p_W, true) + 1e-9);
    EXPECT_LE(clearance.CalcUnknownDistance(p_W), clearance.CalcObstacleDistance(p_W) + 1e-9);
  }
}

TEST(MapClearance, TellsOccupiedFromUnknown) {
  const MapClearance clearance(MakeHalfScannedStatue(0.0));
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
    for (int step = 0; step <= 4; ++step) {
      const Pose X_WF = Interpolate(points[k].X_WF, points[k + 1].X_WF, step / 4.0);
      for (const Sphere& sphere : body.spheres_B()) {
        const double distance = CalcTrueDistance(grid, X_WF * sphere.center, true);
        slack = std::min(slack, distance - sphere.radius_m - body.margin_m());
      }
    }
  }
  EXPECT_GE(slack, -kSweepTolerance / 2.0);
}

INSTANTIATE_TEST_SUITE_P(RandomRequests, MapMotion, testing::Range<uint64_t>(1, 5));

}  // namespace
}  // namespace nbs
