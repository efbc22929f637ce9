#include "services/planner/motion_planning/se3_search.h"

#include <gtest/gtest.h>
#include <ompl/util/RandomNumbers.h>

#include "services/planner/motion_planning/swept_check.h"
#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

const Eigen::Quaterniond kUpright = Eigen::Quaterniond::Identity();

/// A wall in the plane x = 0 with a square hole in its middle.
BoxWorld MakeWallWithGap(double half_gap_m) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-0.02, -2, -2}, {0.02, -half_gap_m, 2}));
  world.occupied.push_back(MakeBox({-0.02, half_gap_m, -2}, {0.02, 2, 2}));
  world.occupied.push_back(MakeBox({-0.02, -2, -2}, {0.02, 2, -half_gap_m}));
  world.occupied.push_back(MakeBox({-0.02, -2, half_gap_m}, {0.02, 2, 2}));
  return world;
}

class Se3Search : public testing::Test {
 protected:
  std::vector<Pose> Find(const BoxWorld& world, const Pose& start, const Pose& goal) const {
    return FindSe3Path(
        start, goal, settings_, [&](const Pose& X) { return body_.FindTouch(world, X) == Touch::kFree; },
        [&](const Pose& from, const Pose& to) { return IsFreeMotion(body_, world, from, to); });
  }

  static Se3SearchSettings MakeSettings() {
    Se3SearchSettings settings;
    settings.box_W = MakeBox({-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8});
    settings.seed = 7;
    return settings;
  }

  Se3SearchSettings settings_ = MakeSettings();
  CollisionBody body_{MakeDefaultSensorBody(), 0.02};
  Pose X_left_ = MakePose({-0.5, 0.3, 0.3}, kUpright);
  Pose X_right_ = MakePose({0.5, 0.3, 0.3}, kUpright);
};

TEST_F(Se3Search, FindsTheWayThroughAGap) {
  const BoxWorld world = MakeWallWithGap(0.25);
  const std::vector<Pose> poses = Find(world, X_left_, X_right_);
  ASSERT_GE(poses.size(), 3u);
  EXPECT_EQ(poses.front().matrix(), X_left_.matrix());
  EXPECT_EQ(poses.back().matrix(), X_right_.matrix());
  for (size_t k = 0; k + 1 < poses.size(); ++k) EXPECT_TRUE(IsFreeMotion(body_, world, poses[k], poses[k + 1]));
}

TEST_F(Se3Search, FindsNothingThroughAClosedWall) {
  EXPECT_TRUE(Find(MakeWallWithGap(0.0), X_left_, X_right_).empty());
}

TEST_F(Se3Search, FindsNothingFromABlockedStart) {
  EXPECT_TRUE(Find(MakeWallWithGap(0.25), MakePose({0, 0.5, 0}, kUpright), X_right_).empty());
}

TEST_F(Se3Search, SameSeedGivesTheSamePathWhateverElseDrewNumbers) {
  const BoxWorld world = MakeWallWithGap(0.2);
  const std::vector<Pose> first = Find(world, X_left_, X_right_);
  ASSERT_FALSE(first.empty());
  ompl::RNG stranger;
  stranger.uniform01();
  settings_.seed = 8;
  Find(world, X_right_, X_left_);
  settings_.seed = 7;
  const std::vector<Pose> second = Find(world, X_left_, X_right_);
  ASSERT_EQ(first.size(), second.size());
  for (size_t k = 0; k < first.size(); ++k) EXPECT_EQ(first[k].matrix(), second[k].matrix());
}

TEST_F(Se3Search, OtherSeedsGiveOtherPaths) {
  const BoxWorld world = MakeWallWithGap(0.2);
  const std::vector<Pose> first = Find(world, X_left_, X_right_);
  settings_.seed = 9;
  const std::vector<Pose> second = Find(world, X_left_, X_right_);
  ASSERT_FALSE(first.empty());
  ASSERT_FALSE(second.empty());
  EXPECT_FALSE(first.size() == second.size() && first[1].matrix() == second[1].matrix());
}

TEST_F(Se3Search, UsesPositionsOutsideTheBoxOnlyForStartAndGoal) {
  settings_.box_W = MakeBox({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4});
  const std::vector<Pose> poses = Find(MakeWallWithGap(0.25), X_left_, X_right_);
  ASSERT_FALSE(poses.empty());
  for (const Pose& X : poses)
    EXPECT_TRUE(MakeBox({-0.501, -0.401, -0.401}, {0.501, 0.401, 0.401}).contains(X.translation()));
}

}  // namespace
}  // namespace nbs
