#include "services/planner/motion_planning/obstacle_pyramid.h"

#include <gtest/gtest.h>

#include "common/kinematics/inverse_kinematics.h"
#include "services/planner/motion_planning/arm_collision.h"
#include "services/planner/motion_planning/map_clearance.h"
#include "tests/common/kinematics/arms.h"
#include "tests/services/planner/motion_planning/arm_cases.h"
#include "tests/services/planner/motion_planning/cell_oracle.h"

namespace nbs {
namespace {

constexpr double kFree = 0.3;

/// Cells of 20 mm of which a few, in an odd box, are occupied, more never observed, and most free.
VoxelGrid MakeSpeckles() {
  VoxelGrid grid(GridShape{{-0.2, -0.1, -0.3}, 0.02, {21, 13, 30}});
  for (size_t i = 0; i < grid.cells().size(); ++i) {
    const double draw = CalcUniform({31, i});
    grid.cells()[i] = draw < 0.004 ? 4000 : draw < 0.01 ? kUnobserved : draw < 0.012 ? 0 : -4000;
  }
  return grid;
}

Eigen::Vector3d MakePoint(uint64_t key, uint64_t i, double reach_m) {
  return reach_m * Eigen::Vector3d(CalcUniform({key, i, 0}) - 0.5, CalcUniform({key, i, 1}) - 0.5,
                                   CalcUniform({key, i, 2}) - 0.5);
}

TEST(ObstaclePyramid, TellsOfCapsulesWhatTheCellsOneByOneTell) {
  const VoxelGrid grid = MakeSpeckles();
  for (const Obstacles obstacles : {Obstacles::kOccupied, Obstacles::kOccupiedOrUnknown}) {
    const ObstaclePyramid pyramid(grid, obstacles, kFree);
    const CellOracle oracle(grid, obstacles, kFree);
    int touched = 0;
    for (uint64_t i = 0; i < 4000; ++i) {
      const Eigen::Vector3d p_A = MakePoint(32, i, 1.0);
      // Some are spheres.
      const Eigen::Vector3d p_B = i % 4 == 0 ? p_A : Eigen::Vector3d(p_A + MakePoint(33, i, 0.4));
      const Capsule capsule{p_A, p_B, 0.001 + 0.08 * CalcUniform({34, i})};
      ASSERT_EQ(pyramid.IsTouched(capsule), oracle.IsTouched(capsule)) << i;
      touched += oracle.IsTouched(capsule) ? 1 : 0;
    }
    EXPECT_GT(touched, 200);
    EXPECT_LT(touched, 3800);
  }
}

TEST(ObstaclePyramid, TellsOfBlocksWhatTheCellsOneByOneTell) {
  const VoxelGrid grid = MakeSpeckles();
  const ObstaclePyramid pyramid(grid, Obstacles::kOccupiedOrUnknown, kFree);
  const CellOracle oracle(grid, Obstacles::kOccupiedOrUnknown, kFree);
  int touched = 0;
  for (uint64_t i = 0; i < 1000; ++i) {
    Block block{MakeRandomPose(35, i, 0.3),
                Eigen::Vector3d::Constant(0.005) + 0.1 * (MakePoint(36, i, 1.0).cwiseAbs())};
    const double margin_m = 0.001 + 0.03 * CalcUniform({37, i});
    ASSERT_EQ(pyramid.IsTouched(block, margin_m), oracle.IsTouched(block, margin_m)) << i;
    touched += oracle.IsTouched(block, margin_m) ? 1 : 0;
  }
  EXPECT_GT(touched, 100);
  EXPECT_LT(touched, 900);
}

TEST(ObstaclePyramid, EverythingOutsideOfTheGridIsFree) {
  const VoxelGrid grid(GridShape{{0, 0, 0}, 0.01, {5, 6, 7}});
  const ObstaclePyramid pyramid(grid, Obstacles::kOccupiedOrUnknown, kFree);
  EXPECT_FALSE(pyramid.IsTouched({{-0.011, 0, 0}, {-0.011, 0.06, 0.07}, 0.01}));
  EXPECT_TRUE(pyramid.IsTouched({{-0.009, 0, 0}, {-0.009, 0.06, 0.07}, 0.01}));
  EXPECT_FALSE(pyramid.IsTouched({{0.061, 0.03, 0.03}, {0.061, 0.03, 0.03}, 0.01}));
  EXPECT_FALSE(ObstaclePyramid(grid, Obstacles::kOccupied, kFree).IsTouched({{0.02, 0.02, 0.02}, {0, 0, 0}, 0.1}));
}

/// The arm with its sensor about a statue of which half is known: joint values even over the limits, and such that the
/// sensor is near the statue.
TEST(ArmCollision, VerdictIsThatOfTheCellsOneByOneInTenThousandStates) {
  const RunConfig config = MakeKr16Run();
  VoxelGrid grid(GridShape{{-0.2, -0.2, 0.0}, 0.02, {20, 20, 30}});
  for (int z = 0; z < 30; ++z) {
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        const double level = std::hypot((x - 9.5) / 5.0, (y - 9.5) / 4.0, (z - 12.0) / 12.5);
        if (x >= 8) grid.cells()[grid.shape().Index(x, y, z)] = level > 1.05 ? -4000 : level > 0.9 ? 4000 : kUnobserved;
      }
    }
  }
  const MapClearance clearance(grid);
  const ArmCollision arm(config, ReadKr16());
  const InverseKinematics ik(arm.model(), IkMethod::kAnalytic);
  const CellOracle unknown(grid, Obstacles::kOccupiedOrUnknown, kFree);
  const CellOracle occupied(grid, Obstacles::kOccupied, kFree);
  int touched = 0;
  for (uint64_t i = 0; i < 10000; ++i) {
    Joints q = MakeRandomJoints(arm.model(), 41, i);
    if (i % 2 == 0) {
      Pose X_WF = MakeRandomPose(42, i, 0.5);
      X_WF.translation().z() += 0.35;
      const std::vector<Joints> found = ik.FindAll(arm.X_WB().inverse() * X_WF);
      if (!found.empty()) q = found[i % found.size()];
    }
    LinkPoses X_BL;
    CalcLinkPoses(arm.model(), q, X_BL);
    const double margin_m = arm.margin_m();
    const bool is_touched = unknown.IsTouched(arm.body(), arm.X_WB(), X_BL, margin_m);
    ASSERT_EQ(arm.TouchesMap(clearance, Obstacles::kOccupiedOrUnknown, q, margin_m), is_touched) << i;
    ASSERT_EQ(arm.TouchesMap(clearance, Obstacles::kOccupied, q, margin_m),
              occupied.IsTouched(arm.body(), arm.X_WB(), X_BL, margin_m))
        << i;
    touched += is_touched ? 1 : 0;
  }
  EXPECT_GT(touched, 1000);
  EXPECT_LT(touched, 9000);
}

}  // namespace
}  // namespace nbs
