#include "sim/pose_error.h"

#include <gtest/gtest.h>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

Pose MakeRandomPose(uint64_t number) {
  const auto draw = [&](uint64_t k) { return CalcGaussian({21, number, k}); };
  return MakePose({draw(0), draw(1), draw(2)}, Eigen::Quaterniond(draw(3), draw(4), draw(5), draw(6)).normalized());
}

TEST(PoseError, BiasStaysWithinAThirdOfItsMeanAndIsTheSameAtTheSamePose) {
  const PoseError error(0.0015, 0.0, 1);
  for (uint64_t k = 0; k < 1000; ++k) {
    const Pose X_WF = MakeRandomPose(k);
    EXPECT_GE(error.CalcBias(X_WF).norm(), 0.001 - 1e-12);
    EXPECT_LE(error.CalcBias(X_WF).norm(), 0.002 + 1e-12);
    EXPECT_EQ(error.CalcTruePose(X_WF, 0).matrix(), error.CalcTruePose(X_WF, 99).matrix());
  }
}

TEST(PoseError, BiasChangesSlowly) {
  const PoseError error(0.0015, 0.0, 1);
  for (uint64_t k = 0; k < 1000; ++k) {
    const Pose X_WF = MakeRandomPose(k);
    Pose X_WF_beside = X_WF;
    X_WF_beside.translation().x() += 0.05;
    EXPECT_LT((error.CalcBias(X_WF) - error.CalcBias(X_WF_beside)).norm(), 0.0004);
  }
}

TEST(PoseError, BiasDiffersBetweenSidesOfTheWorkSpaceAndSeeds) {
  double largest = 0.0;
  const PoseError error(0.0015, 0.0, 1);
  for (uint64_t k = 0; k < 100; ++k)
    largest = std::max(largest, (error.CalcBias(MakeRandomPose(k)) - error.CalcBias(MakeRandomPose(k + 1))).norm());
  EXPECT_GT(largest, 0.001);
  EXPECT_NE(error.CalcBias(MakeRandomPose(0)), PoseError(0.0015, 0.0, 2).CalcBias(MakeRandomPose(0)));
}

TEST(PoseError, NoiseHasItsDeviationAndDependsOnTheInstant) {
  const PoseError error(0.0, 5e-5, 1);
  const Pose X_WF = MakeRandomPose(0);
  double sum = 0.0;
  constexpr int kInstants = 20000;
  for (int k = 0; k < kInstants; ++k)
    sum += (error.CalcTruePose(X_WF, 40000 * k).translation() - X_WF.translation()).squaredNorm();
  EXPECT_NEAR(std::sqrt(sum / (3 * kInstants)), 5e-5, 1e-6);
}

TEST(PoseError, FreeFlyingSensorIsWhereItSays) {
  const Pose X_WF = MakeRandomPose(0);
  EXPECT_EQ(PoseError::Make(RunConfig{}).CalcTruePose(X_WF, 5).matrix(), X_WF.matrix());
}

}  // namespace
}  // namespace nbs
