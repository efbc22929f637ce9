#include "services/planner/motion_planning/swept_check.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

const Eigen::Quaterniond kUpright = Eigen::Quaterniond::Identity();

CollisionBody MakeBall() { return {{{{0, 0, 0}, 0.05}}, 0.02}; }

Sweep SweepLine(const CollisionBody& body, const Clearance& world, const Pose& start, const Pose& end) {
  return SweepPath(body, world, std::vector<Pose>{start, end});
}

TEST(SweptCheck, FindsAFoilThatDenseStepsWouldPass) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.5, -1, -1}, {0.500001, 1, 1}));
  const CollisionBody needle({{{0, 0, 0}, 1e-4}}, 0.001);
  EXPECT_FALSE(IsFreeMotion(needle, world, Pose::Identity(), MakePose({1, 0, 0}, kUpright)));
}

TEST(SweptCheck, FreeIntervalEndsAtTheWall) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.57, -1, -1}, {2, 1, 1}));
  const Sweep sweep = SweepLine(MakeBall(), world, Pose::Identity(), MakePose({1, 0, 0}, kUpright));
  EXPECT_EQ(sweep.worst, Touch::kOccupied);
  ASSERT_EQ(sweep.free.size(), 1u);
  EXPECT_EQ(sweep.free[0].begin, 0.0);
  EXPECT_LE(sweep.free[0].end, 0.5);
  EXPECT_GE(sweep.free[0].end, 0.5 - 0.0011);
}

TEST(SweptCheck, FindsBothSidesOfAWallAndTheLongerOne) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({0.37, -1, -1}, {0.43, 1, 1}));
  const Sweep sweep = SweepLine(MakeBall(), world, Pose::Identity(), MakePose({1, 0, 0}, kUpright));
  EXPECT_EQ(sweep.worst, Touch::kUnknown);
  ASSERT_EQ(sweep.free.size(), 2u);
  const FreeInterval longest = *sweep.FindLongest();
  EXPECT_NEAR(longest.begin, 0.5, 0.0011);
  EXPECT_GE(longest.begin, 0.5);
  EXPECT_EQ(longest.end, 1.0);
}

TEST(SweptCheck, OccupiedGoesBeforeUnknown) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({0.2, -1, -1}, {0.3, 1, 1}));
  world.occupied.push_back(MakeBox({0.6, -1, -1}, {0.7, 1, 1}));
  EXPECT_EQ(SweepLine(MakeBall(), world, Pose::Identity(), MakePose({1, 0, 0}, kUpright)).worst, Touch::kOccupied);
}

TEST(SweptCheck, SeesWhatATurningArmSweeps) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.30, 0.30, -0.01}, {0.31, 0.31, 0.01}));
  const CollisionBody arm({{{0.43, 0, 0}, 0.02}}, 0.0);
  const Pose turned =
      MakePose({0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ())));
  EXPECT_FALSE(IsFreeMotion(arm, world, Pose::Identity(), turned));
  EXPECT_EQ(arm.FindTouch(world, Pose::Identity()), Touch::kFree);
  EXPECT_EQ(arm.FindTouch(world, turned), Touch::kFree);
}

TEST(SweptCheck, ASinglePoseIsAPathWithoutLength) {
  const BoxWorld empty;
  const Sweep sweep = SweepPath(MakeBall(), empty, std::vector<Pose>{Pose::Identity()});
  EXPECT_TRUE(sweep.is_free());
  EXPECT_EQ(*sweep.FindLongest(), (FreeInterval{0.0, 1.0}));
  EXPECT_THROW(SweepPath(MakeBall(), empty, {}), std::invalid_argument);
}

TEST(SweptCheck, NothingFreeHasNoLongestInterval) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-2, -2, -2}, {2, 2, 2}));
  EXPECT_FALSE(SweepLine(MakeBall(), world, Pose::Identity(), MakePose({1, 0, 0}, kUpright)).FindLongest());
}

TEST(SweptCheck, AnIntervalRunsOnOverThePosesOfAPath) {
  const BoxWorld empty;
  const std::vector<Pose> poses = {Pose::Identity(), MakePose({0.5, 0, 0}, kUpright),
                                   MakePose({0.5, 0.5, 0}, kUpright)};
  EXPECT_EQ(SweepPath(MakeBall(), empty, poses).free, (std::vector<FreeInterval>{{0.0, 1.0}}));
}

/// Random boxes, occupied and unknown.
BoxWorld MakeClutter(uint64_t seed) {
  BoxWorld world;
  for (uint64_t k = 0; k < 6; ++k) {
    const Eigen::Vector3d low = MakeRandomPose(seed, k, 0.4).translation();
    const Eigen::Vector3d size =
        0.1 * Eigen::Vector3d(CalcUniform({seed, k, 20}), CalcUniform({seed, k, 21}), CalcUniform({seed, k, 22}));
    (k % 2 == 0 ? world.occupied : world.unknown).emplace_back(low, low + size);
  }
  return world;
}

class SweptCheckOracle : public testing::TestWithParam<uint64_t> {
 protected:
  SweptCheckOracle() : world_(MakeClutter(GetParam())) {}

  static constexpr int kSteps = 2000;
  static constexpr double kHalf = kSweepTolerance / 2.0;

  BoxWorld world_;
  CollisionBody body_{MakeDefaultSensorBody(), 0.02};
  Pose X_start_ = MakeRandomPose(GetParam(), 100, 0.5);
  Pose X_end_ = MakeRandomPose(GetParam(), 101, 0.5);
};

TEST_P(SweptCheckOracle, EveryDenseSampleOfAFreeIntervalKeepsTheMargin) {
  const Sweep sweep = SweepLine(body_, world_, X_start_, X_end_);
  for (const FreeInterval& interval : sweep.free) {
    for (int k = 0; k <= kSteps; ++k) {
      const double fraction = interval.begin + interval.length() * k / kSteps;
      ASSERT_GE(body_.CalcSlack(world_, Interpolate(X_start_, X_end_, fraction)), -kHalf - 1e-9) << "at " << fraction;
    }
  }
}

TEST_P(SweptCheckOracle, NoDenseSampleOutsideTheFreeIntervalsIsClearlyFree) {
  const Sweep sweep = SweepLine(body_, world_, X_start_, X_end_);
  for (int k = 0; k <= kSteps; ++k) {
    const double fraction = static_cast<double>(k) / kSteps;
    if (body_.CalcSlack(world_, Interpolate(X_start_, X_end_, fraction)) < kSweepTolerance) continue;
    const bool inside = std::any_of(sweep.free.begin(), sweep.free.end(), [&](const FreeInterval& interval) {
      return interval.begin <= fraction && fraction <= interval.end;
    });
    ASSERT_TRUE(inside) << "at " << fraction;
  }
}

TEST_P(SweptCheckOracle, WorstTouchIsThatOfDenseSamples) {
  const Sweep sweep = SweepLine(body_, world_, X_start_, X_end_);
  Touch worst = Touch::kFree;
  double slack = 1.0;
  for (int k = 0; k <= kSteps; ++k) {
    const Pose X = Interpolate(X_start_, X_end_, static_cast<double>(k) / kSteps);
    worst = std::max(worst, body_.FindTouch(world_, X));
    slack = std::min(slack, body_.CalcSlack(world_, X));
  }
  if (std::abs(slack) > kSweepTolerance) {
    EXPECT_EQ(sweep.is_free(), worst == Touch::kFree);
  }
  EXPECT_EQ(IsFreeMotion(body_, world_, X_start_, X_end_), sweep.is_free());
}

TEST_P(SweptCheckOracle, ReversedPathIsFreeExactlyWhereThePathIs) {
  const Sweep forth = SweepLine(body_, world_, X_start_, X_end_);
  const Sweep back = SweepLine(body_, world_, X_end_, X_start_);
  double forth_free = 0.0;
  double back_free = 0.0;
  for (const FreeInterval& interval : forth.free) forth_free += interval.length();
  for (const FreeInterval& interval : back.free) back_free += interval.length();
  EXPECT_NEAR(forth_free, back_free, 0.02);
}

INSTANTIATE_TEST_SUITE_P(RandomPaths, SweptCheckOracle, testing::Range<uint64_t>(1, 61));

}  // namespace
}  // namespace nbs
