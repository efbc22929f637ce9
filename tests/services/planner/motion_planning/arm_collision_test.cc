#include "services/planner/motion_planning/arm_collision.h"

#include <gtest/gtest.h>

#include "tests/common/kinematics/arms.h"
#include "tests/services/planner/motion_planning/arm_cases.h"

namespace nbs {
namespace {

ArmCollision MakeCollision() { return {MakeKr16Run(), ReadKr16()}; }

Joints MakeStart() {
  const std::vector<double> start = MakeKr16Run().cell.arm->start_rad;
  return Eigen::Map<const Eigen::VectorXd>(start.data(), 6);
}

TEST(ArmCollision, StartOfTheCellIsFreeOfItsUnknownBox) {
  const RunConfig config = MakeKr16Run();
  BoxWorld world;
  world.unknown.push_back({config.grid.origin_W, config.grid.origin_W + 0.005 * config.grid.size.cast<double>()});
  EXPECT_EQ(MakeCollision().FindTouch(world, MakeStart()), ArmTouch::kFree);
}

TEST(ArmCollision, OccupiedGoesBeforeUnknownAndItselfBeforeBoth) {
  const ArmCollision arm = MakeCollision();
  const Pose X_WF = arm.X_WB() * CalcFlangePose(arm.model(), MakeStart());
  BoxWorld world;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.01);
  world.unknown.push_back({X_WF.translation() - half, X_WF.translation() + half});
  EXPECT_EQ(arm.FindTouch(world, MakeStart()), ArmTouch::kUnknown);
  world.occupied = world.unknown;
  EXPECT_EQ(arm.FindTouch(world, MakeStart()), ArmTouch::kOccupied);
  Joints folded(6);
  folded << 0, -0.5, 2.68, 0, 2.2, 0;
  EXPECT_EQ(arm.FindTouch(world, folded), ArmTouch::kSelf);
}

TEST(ArmCollision, MarginIsKept) {
  const ArmCollision arm = MakeCollision();
  LinkPoses X_BL;
  CalcLinkPoses(arm.model(), MakeStart(), X_BL);
  const ArmPart& sensor = arm.body().parts().back();
  const Capsule& sphere = sensor.spheres.front();
  const Eigen::Vector3d p_W = arm.X_WB() * X_BL[6] * sphere.p_A;
  for (const double gap : {arm.margin_m() - 0.001, arm.margin_m() + 0.001}) {
    BoxWorld world;
    const double high = p_W.z() - sphere.radius_m - gap;
    // Nothing of the sensor reaches lower beside this sphere's own column.
    world.occupied.push_back(
        MakeBox({p_W.x() - 1e-3, p_W.y() - 1e-3, high - 0.01}, {p_W.x() + 1e-3, p_W.y() + 1e-3, high}));
    EXPECT_EQ(arm.IsFree(world, MakeStart()), gap > arm.margin_m());
  }
}

TEST(ArmCollision, TableAndFloorAreTouchedAsTheArmItself) {
  const ArmCollision arm = MakeCollision();
  Joints low(6);
  low << 0, -0.35, 0.9, 0, 0.3, 0;  // the hand reaches forward and down
  EXPECT_EQ(arm.FindTouch(BoxWorld{}, low), ArmTouch::kSelf);
}

TEST(ArmCollision, FreeMotionIsFreeAtEveryStateBetween) {
  const ArmCollision arm = MakeCollision();
  const BoxWorld world = MakeObjectWorld();
  int free_motions = 0;
  for (int i = 0; i < 400; ++i) {
    const Joints q_from = MakeRandomJoints(arm.model(), 11, i);
    const Joints q_to = q_from + 0.15 * (MakeRandomJoints(arm.model(), 12, i) - q_from);
    const bool free = arm.IsFreeMotion(world, q_from, q_to);
    bool touches = false;
    bool is_near = false;
    for (int s = 0; s <= 300; ++s) {
      const Joints q = q_from + s / 300.0 * (q_to - q_from);
      EXPECT_TRUE(!free || arm.IsFree(world, q, 0.5 * kArmSweepTolerance)) << i;
      touches = touches || !arm.IsFree(world, q);
      is_near = is_near || !arm.IsFree(world, q, -0.001);
    }
    free_motions += free ? 1 : 0;
    EXPECT_TRUE(free || touches || is_near) << i;
  }
  EXPECT_GT(free_motions, 20);
}

}  // namespace
}  // namespace nbs
