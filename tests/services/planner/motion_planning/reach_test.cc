#include "services/planner/motion_planning/reach.h"

#include <gtest/gtest.h>

#include "services/planner/motion_planning/flange_path.h"
#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

/// 1 m along x, looking down.
ScanPath MakeLine() {
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  return {MakeLookPose({0, 0, 0}, down, Eigen::Vector3d::UnitX()),
          MakeLookPose({1, 0, 0}, down, Eigen::Vector3d::UnitX())};
}

CollisionBody MakeBall() { return {{{{0, 0, 0}, 0.05}}, 0.02}; }

Reach Find(const Clearance& world, const ScanPath& path, double min_part_m = 0.03) {
  return FindReach(MakeBall(), Pose::Identity(), world, path, min_part_m);
}

TEST(Reach, FreePathIsReachableInBothRolls) {
  const Reach reach = Find(BoxWorld{}, MakeLine());
  EXPECT_EQ(reach.verdict, Verdict::kReachable);
  ASSERT_EQ(reach.paths.size(), 2u);
  EXPECT_EQ(reach.paths[0].X_WS_start.matrix(), MakeLine().X_WS_start.matrix());
}

TEST(Reach, WallInTheWayLeavesTheLongerPart) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.33, -1, -1}, {0.34, 1, 1}));
  const Reach reach = Find(world, MakeLine());
  EXPECT_EQ(reach.verdict, Verdict::kPartly);
  ASSERT_FALSE(reach.paths.empty());
  EXPECT_NEAR(reach.paths[0].X_WS_start.translation().x(), 0.41, 0.0011);
  EXPECT_EQ(reach.paths[0].X_WS_end.translation().x(), 1.0);
}

TEST(Reach, TooShortAPartIsNone) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.09, -1, -1}, {2, 1, 1}));
  EXPECT_EQ(Find(world, MakeLine(), 0.03).verdict, Verdict::kBlockedByObstacle);
  EXPECT_EQ(Find(world, MakeLine(), 0.01).verdict, Verdict::kPartly);
}

TEST(Reach, UnknownAroundBlocksForNow) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({-1, -1, -1}, {2, 1, 1}));
  EXPECT_EQ(Find(world, MakeLine()).verdict, Verdict::kBlockedByUnknown);
}

TEST(Reach, ObstacleBehindUnknownBlocksForNowWhileAPartMayOpen) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({-1, -1, -1}, {2, 1, 1}));
  world.occupied.push_back(MakeBox({0.5, -1, -1}, {2, 1, 1}));
  EXPECT_EQ(Find(world, MakeLine()).verdict, Verdict::kBlockedByUnknown);
}

TEST(Reach, PathInsideAnObstacleIsBlockedForGood) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-1, -1, -1}, {2, 1, 1}));
  EXPECT_EQ(Find(world, MakeLine()).verdict, Verdict::kBlockedByObstacle);
}

TEST(Reach, PathShorterThanAPartIsAllOrNothing) {
  ScanPath path = MakeLine();
  path.X_WS_end.translation().x() = 0.02;
  BoxWorld world;
  EXPECT_EQ(Find(world, path).verdict, Verdict::kReachable);
  world.occupied.push_back(MakeBox({0.085, -1, -1}, {2, 1, 1}));
  EXPECT_EQ(Find(world, path).verdict, Verdict::kBlockedByObstacle);
}

TEST(Reach, RolledBodyPassesWhereTheStandingOneDoesNot) {
  const CollisionBody lopsided({{{0, 0, 0}, 0.02}, {{0.2, 0, 0}, 0.05}}, 0.02);
  BoxWorld world;
  const ScanPath path = MakeLine();
  const Eigen::Vector3d ball_W = path.X_WS_start * Eigen::Vector3d(0.2, 0, 0);
  world.occupied.push_back(MakeBox({-1, ball_W.y() - 0.01, -1}, {2, ball_W.y() + 0.01, 1}));
  const Reach reach = FindReach(lopsided, Pose::Identity(), world, path, 0.03);
  EXPECT_EQ(reach.verdict, Verdict::kReachable);
  ASSERT_EQ(reach.paths.size(), 1u);
  EXPECT_EQ(reach.paths[0].X_WS_start.matrix(), RollPath(path).X_WS_start.matrix());
}

TEST(FlangePath, RollTwiceIsTheSamePath) {
  const ScanPath path = MakeLine();
  EXPECT_EQ(RollPath(RollPath(path)).X_WS_end.matrix(), path.X_WS_end.matrix());
  EXPECT_TRUE(IsRigid(RollPath(path).X_WS_start));
  EXPECT_EQ(RollPath(path).X_WS_start.linear().col(2), path.X_WS_start.linear().col(2));
}

TEST(FlangePath, TwoPosesWithoutTurnOrOffset) {
  EXPECT_EQ(MakeFlangePath(MakePose({0.1, 0, 0.2}, Eigen::Quaterniond::Identity()), MakeLine()).size(), 2u);
  ScanPath turning = MakeLine();
  turning.X_WS_end.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()) * turning.X_WS_end.linear();
  EXPECT_EQ(MakeFlangePath(Pose::Identity(), turning).size(), 2u);
}

TEST(FlangePath, SensorStaysOnItsLineWhileTheFlangeTurns) {
  const Pose X_FS = MakePose({0.1, 0.0, 0.2}, Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY())));
  ScanPath path = MakeLine();
  path.X_WS_end.linear() = Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, 3).normalized()) * path.X_WS_end.linear();
  const std::vector<Pose> poses_WF = MakeFlangePath(X_FS, path);
  for (int k = 0; k <= 1000; ++k) {
    const double at = k / 1000.0 * static_cast<double>(poses_WF.size() - 1);
    const size_t piece = std::min(static_cast<size_t>(at), poses_WF.size() - 2);
    const Pose X_WS = Interpolate(poses_WF[piece], poses_WF[piece + 1], at - static_cast<double>(piece)) * X_FS;
    const Pose wanted = Interpolate(path.X_WS_start, path.X_WS_end, k / 1000.0);
    ASSERT_LT((X_WS.translation() - wanted.translation()).norm(), 2e-4);
    ASSERT_LT(CalcAngleBetween(X_WS, wanted), 1e-6);
  }
}

}  // namespace
}  // namespace nbs
