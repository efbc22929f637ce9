#include "services/planner/motion_planning/escape.h"

#include <gtest/gtest.h>

#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

CollisionBody MakeBall() { return {{{{0, 0, 0}, 0.05}}, 0.02}; }

TEST(Escape, StaysWhereTheMarginIsKept) {
  const Pose X = MakePose({0.1, 0.2, 0.3}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(FindEscape(MakeBall(), BoxWorld{}, X, X.linear())->matrix(), X.matrix());
}

TEST(Escape, BacksOffFromWhatItLooksAt) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-1, -1, 0.06}, {1, 1, 1}));
  const std::optional<Pose> X = FindEscape(MakeBall(), world, Pose::Identity(), Eigen::Matrix3d::Identity());
  ASSERT_TRUE(X);
  EXPECT_TRUE(X->translation().isApprox(Eigen::Vector3d(0, 0, -0.02), 1e-12));
  EXPECT_EQ(MakeBall().FindTouch(world, *X), Touch::kFree);
}

/// A shaft that is open at its lower end z = -0.12; its walls stand 12 mm off the ball, the one towards +x as far as
/// asked, the floor above it 10 mm.
BoxWorld MakeShaft(double wall_x_m) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-1, -1, 0.06}, {1, 1, 1}));
  world.occupied.push_back(MakeBox({wall_x_m, -1, -0.12}, {1, 1, -0.02}));
  world.occupied.push_back(MakeBox({-1, -1, -0.12}, {-0.062, 1, 1}));
  world.occupied.push_back(MakeBox({-1, 0.062, -0.12}, {1, 1, 1}));
  world.occupied.push_back(MakeBox({-1, -1, -0.12}, {1, -0.062, 1}));
  return world;
}

TEST(Escape, GoesAsFarAsTheMarginAsks) {
  const std::optional<Pose> X = FindEscape(MakeBall(), MakeShaft(0.062), Pose::Identity(), Eigen::Matrix3d::Identity());
  ASSERT_TRUE(X);
  EXPECT_TRUE(X->translation().isApprox(Eigen::Vector3d(0, 0, -0.2), 1e-12));
}

TEST(Escape, NeverGoesNearerThanItStands) {
  EXPECT_FALSE(FindEscape(MakeBall(), MakeShaft(0.058), Pose::Identity(), Eigen::Matrix3d::Identity()));
}

TEST(Escape, GivesUpWhereTheBodyTouches) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-1, -1, 0.04}, {1, 1, 1}));
  EXPECT_FALSE(FindEscape(MakeBall(), world, Pose::Identity(), Eigen::Matrix3d::Identity()));
}

}  // namespace
}  // namespace nbs
