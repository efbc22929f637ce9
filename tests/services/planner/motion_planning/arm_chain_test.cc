#include "services/planner/motion_planning/arm_chain.h"

#include <gtest/gtest.h>

#include <set>

#include "services/planner/motion_planning/arm_reach.h"
#include "tests/common/kinematics/arms.h"
#include "tests/services/planner/motion_planning/arm_cases.h"

namespace nbs {
namespace {

ArmSetup MakeSetup(const RunConfig& config = MakeKr16Run()) {
  const ArmModel model = ReadKr16();
  return {InverseKinematics(model, IkMethod::kAnalytic), ArmCollision(config, model), config.cell.X_FS, 0.05};
}

/// A path that the arm can follow as it stands.
ScanPath MakeGoodPath() { return MakePathAbout(3.0); }

struct Following {
  std::vector<JointChain> chains;
  Verdict verdict = Verdict::kReachable;
};

Following Follow(const ArmSetup& arm, const Clearance& world, const ScanPath& path, double speed = 0.05) {
  const std::vector<Pose> line_WF = MakeLine(arm.X_FS, path);
  const int steps = static_cast<int>(line_WF.size()) - 1;
  JointLadder ladder(arm.ik, arm.collision, world, line_WF, path.length_m() / steps / speed);
  std::vector<JointChain> chains = ladder.FindChains(steps + 1);
  const Verdict verdict = chains.empty() ? ladder.FindReason(steps + 1) : Verdict::kReachable;
  return {std::move(chains), verdict};
}

TEST(ArmChain, FollowsTheLineWithoutJumps) {
  const ArmSetup arm = MakeSetup();
  const ScanPath path = MakeGoodPath();
  const Following result = Follow(arm, MakeObjectWorld(), path);
  ASSERT_FALSE(result.chains.empty());
  const std::vector<Pose> line_WF = MakeLine(arm.X_FS, path);
  for (const JointChain& chain : result.chains) {
    ASSERT_EQ(chain.q.size(), line_WF.size());
    for (size_t k = 0; k < chain.q.size(); ++k) {
      const Pose X_WF = arm.collision.X_WB() * CalcFlangePose(arm.ik.model(), chain.q[k]);
      EXPECT_LT((X_WF.matrix() - line_WF[k].matrix()).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_EQ(arm.collision.FindTouch(MakeObjectWorld(), chain.q[k]), ArmTouch::kFree);
      const Joints& before = chain.q[k > 0 ? k - 1 : 0];
      EXPECT_LT((chain.q[k] - before).cwiseAbs().maxCoeff(), 0.1);
    }
  }
}

TEST(ArmChain, LeastTravelGoesFirst) {
  const Following result = Follow(MakeSetup(), MakeObjectWorld(), MakeGoodPath());
  for (size_t k = 1; k < result.chains.size(); ++k)
    EXPECT_LE(result.chains[k - 1].travel_rad, result.chains[k].travel_rad);
}

TEST(ArmChain, OutOfReachIsNoInverseKinematics) {
  EXPECT_EQ(Follow(MakeSetup(), BoxWorld{}, MakePathAbout(0.0, 2.5)).verdict, Verdict::kNoInverseKinematics);
}

TEST(ArmChain, BeyondTheLimitsIsAJointLimit) {
  RunConfig config = MakeKr16Run();
  ArmModel model = ReadKr16();
  // A5 cannot bend back.
  model.joints[4].min_rad = 1.9;
  model.joints[4].max_rad = 2.0;
  const ArmSetup arm{InverseKinematics(model, IkMethod::kAnalytic), ArmCollision(config, model), config.cell.X_FS,
                     0.05};
  EXPECT_EQ(Follow(arm, BoxWorld{}, MakeGoodPath()).verdict, Verdict::kJointLimit);
}

TEST(ArmChain, FasterThanTheJointsIsSpeed) {
  const ArmSetup arm = MakeSetup();
  EXPECT_TRUE(Follow(arm, BoxWorld{}, MakeGoodPath(), 1.0).verdict == Verdict::kReachable);
  EXPECT_EQ(Follow(arm, BoxWorld{}, MakeGoodPath(), 50.0).verdict, Verdict::kSpeed);
}

TEST(ArmChain, ObstacleUnknownSpaceAndTheArmItselfAreToldApart) {
  const ArmSetup arm = MakeSetup();
  const ScanPath path = MakeGoodPath();
  const Eigen::Vector3d p_W = 0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation());
  BoxWorld world;
  world.unknown.push_back({p_W - Eigen::Vector3d::Constant(0.05), p_W + Eigen::Vector3d::Constant(0.05)});
  EXPECT_EQ(Follow(arm, world, path).verdict, Verdict::kBlockedByUnknown);
  world.occupied = world.unknown;
  EXPECT_EQ(Follow(arm, world, path).verdict, Verdict::kBlockedByObstacle);
  // Below the table.
  EXPECT_EQ(Follow(arm, BoxWorld{}, MakePathAbout(3.0, 0.42, -0.25)).verdict, Verdict::kSelfCollision);
}

TEST(ArmReach, PartOfAPathIsReachableWhenLookedAtAgain) {
  const ArmSetup arm = MakeSetup();
  ScanPath path = MakePathAbout(3.0);
  path.X_WS_start.translation().z() -= 0.35;  // begins below the table
  const BoxWorld world = MakeObjectWorld();
  const ArmReach reach = FindArmReach(arm, world, path);
  ASSERT_EQ(reach.verdict, Verdict::kPartly);
  const ScanPath part = reach.drives.front().path;
  EXPECT_GT(part.length_m(), 0.15);
  EXPECT_LT(part.length_m(), path.length_m() - 0.1);
  EXPECT_EQ(FindArmReach(arm, world, part).verdict, Verdict::kReachable);
}

TEST(ArmReach, CheckFindsTheVerdictAndTheFirstOfAllDrives) {
  const ArmSetup arm = MakeSetup();
  BoxWorld world = MakeObjectWorld();
  world.unknown.push_back(MakeBox({-0.15, -0.15, 0.2}, {0.15, 0.3, 0.4}));
  std::set<Verdict> seen;
  for (int i = 0; i < 60; ++i) {
    const auto draw = [i](uint64_t k) { return CalcUniform({21, static_cast<uint64_t>(i), k}); };
    const ScanPath path = MakePathAbout(6.28 * draw(0), 0.2 + 0.5 * draw(1), -0.2 + 0.6 * draw(2));
    const ArmReach reach = FindArmReach(arm, world, path);
    const PathCheck check = CheckArmPath(arm, world, path);
    ASSERT_EQ(check.verdict, reach.verdict) << i;
    const ScanPath& first = reach.drives.empty() ? path : reach.drives.front().path;
    EXPECT_EQ(check.path.X_WS_start.matrix(), first.X_WS_start.matrix()) << i;
    EXPECT_EQ(check.path.X_WS_end.matrix(), first.X_WS_end.matrix()) << i;
    seen.insert(check.verdict);
  }
  EXPECT_GE(seen.size(), 4u);
}

TEST(ArmReach, EveryPathIsOfferedFromBothEnds) {
  const ArmReach reach = FindArmReach(MakeSetup(), MakeObjectWorld(), MakePathAbout(3.0));
  ASSERT_EQ(reach.verdict, Verdict::kReachable);
  for (const ArmDrive& drive : reach.drives) {
    const auto is_back = [&](const ArmDrive& other) {
      return (other.q.front() - drive.q.back()).norm() < 1e-9 && (other.q.back() - drive.q.front()).norm() < 1e-9;
    };
    EXPECT_TRUE(std::any_of(reach.drives.begin(), reach.drives.end(), is_back));
  }
}

}  // namespace
}  // namespace nbs
