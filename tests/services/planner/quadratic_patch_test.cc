#include "services/planner/quadratic_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

Pose MakeFrame() { return MakePose({0.1, -0.2, 0.3}, Eigen::Quaterniond(0.5, -0.1, 0.7, 0.2)); }

/// 11 x 11 points over ±extent/2 of the surface, with Gaussian noise along z.
std::vector<Eigen::Vector3d> Sample(const Pose& X_WP, const Vector6d& c, double extent, double noise = 0.0) {
  std::vector<Eigen::Vector3d> points_W;
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      const double x = extent * (i / 10.0 - 0.5);
      const double y = extent * (j / 10.0 - 0.5);
      const double z = c(0) * x * x + c(1) * x * y + c(2) * y * y + c(3) * x + c(4) * y + c(5);
      points_W.push_back(X_WP * Eigen::Vector3d(x, y, z + noise * CalcGaussian({3, points_W.size()})));
    }
  }
  return points_W;
}

const QuadraticPatchSettings kPlain{.noise_m = 0.0};
const Vector6d kQuadric = (Vector6d() << -8.0, 3.0, 5.0, 0.2, -0.1, 0.002).finished();

Eigen::Vector3d CalcPoint_P(const QuadraticPatch& patch, double x, double y) { return {x, y, patch.CalcHeight(x, y)}; }

TEST(QuadraticPatch, ExactQuadricIsRecovered) {
  const auto patch = FitQuadraticPatch(MakeFrame(), Sample(MakeFrame(), kQuadric, 0.04), kPlain);
  ASSERT_TRUE(patch);
  EXPECT_NEAR((patch->coefficients - kQuadric).norm(), 0.0, 1e-7);
  EXPECT_NEAR(patch->rms_m, 0.0, 1e-10);
  EXPECT_EQ(patch->points, 121);
}

TEST(QuadraticPatch, PointsOfAnExactQuadricLieOnIt) {
  const auto points_W = Sample(MakeFrame(), kQuadric, 0.04);
  const auto patch = FitQuadraticPatch(MakeFrame(), points_W, kPlain);
  ASSERT_TRUE(patch);
  for (const Eigen::Vector3d& p_W : points_W) {
    const Eigen::Vector3d p_P = MakeFrame().inverse() * p_W;
    EXPECT_NEAR((CalcPoint_P(*patch, p_P.x(), p_P.y()) - p_P).norm(), 0.0, 1e-9);
  }
}

TEST(QuadraticPatch, NormalIsPerpendicularToNumericTangents) {
  const auto patch = FitQuadraticPatch(MakeFrame(), Sample(MakeFrame(), kQuadric, 0.04));
  ASSERT_TRUE(patch);
  constexpr double kStep = 1e-6;
  for (double x : {-0.05, 0.0, 0.03}) {
    const Eigen::Vector3d p = CalcPoint_P(*patch, x, 0.01);
    const Eigen::Vector3d n = patch->CalcNormal_P(x, 0.01);
    EXPECT_NEAR(n.norm(), 1.0, 1e-12);
    EXPECT_NEAR((CalcPoint_P(*patch, x + kStep, 0.01) - p).normalized().dot(n), 0.0, 1e-4);
    EXPECT_NEAR((CalcPoint_P(*patch, x, 0.01 + kStep) - p).normalized().dot(n), 0.0, 1e-4);
    EXPECT_GT(n.z(), 0.0);
  }
}

TEST(QuadraticPatch, CurvatureOfACylinderIsOneOverItsRadius) {
  const double radius = 0.08;
  std::vector<Eigen::Vector3d> points_W;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -5; j <= 5; ++j) {
      const double angle = 0.02 * i;
      points_W.emplace_back(radius * std::sin(angle), 0.004 * j, radius * (std::cos(angle) - 1.0));
    }
  }
  const auto patch = FitQuadraticPatch(Pose::Identity(), points_W);
  ASSERT_TRUE(patch);
  EXPECT_NEAR(patch->CalcCurvatureAlongX(0.0, 0.0), -1.0 / radius, 0.03 / radius);
}

TEST(QuadraticPatch, NoiseOfHalfAMillimetreLeavesTheNormalWithinAFewDegrees) {
  const auto patch = FitQuadraticPatch(MakeFrame(), Sample(MakeFrame(), kQuadric, 0.04, 0.0005));
  const auto exact = FitQuadraticPatch(MakeFrame(), Sample(MakeFrame(), kQuadric, 0.04), kPlain);
  ASSERT_TRUE(patch && exact);
  EXPECT_NEAR(patch->rms_m, 0.0005, 0.0001);
  for (double x : {-0.02, 0.0, 0.02, 0.04}) {
    EXPECT_GT(patch->CalcNormal_P(x, 0.0).dot(exact->CalcNormal_P(x, 0.0)), std::cos(0.07)) << x;  // 4 degrees
  }
}

TEST(QuadraticPatch, FewNoisyPointsOnASmallSpotGiveNearlyAPlane) {
  const Vector6d plane = (Vector6d() << 0, 0, 0, 0.1, 0, 0).finished();
  const auto points_W = Sample(Pose::Identity(), plane, 0.005, 0.0005);
  const auto plain = FitQuadraticPatch(Pose::Identity(), points_W, kPlain);
  const auto held = FitQuadraticPatch(Pose::Identity(), points_W);
  ASSERT_TRUE(plain && held);
  EXPECT_GT(plain->coefficients.head<3>().norm(), 20.0);
  EXPECT_LT(held->coefficients.head<3>().norm(), 10.0);  // the standard deviation of the prior
}

TEST(QuadraticPatch, ResultTurnsWithTheFrame) {
  const auto here = FitQuadraticPatch(Pose::Identity(), Sample(Pose::Identity(), kQuadric, 0.04, 0.0003));
  const auto there = FitQuadraticPatch(MakeFrame(), Sample(MakeFrame(), kQuadric, 0.04, 0.0003));
  ASSERT_TRUE(here && there);
  EXPECT_NEAR((here->coefficients - there->coefficients).norm(), 0.0, 1e-6);
}

TEST(QuadraticPatch, TooFewPointsGiveNone) {
  auto points_W = Sample(Pose::Identity(), kQuadric, 0.04);
  points_W.resize(11);
  EXPECT_FALSE(FitQuadraticPatch(Pose::Identity(), points_W));
  EXPECT_FALSE(FitQuadraticPatch(Pose::Identity(), {}));
}

TEST(QuadraticPatch, PointsOnALineGiveNone) {
  std::vector<Eigen::Vector3d> line_W;
  for (int i = 0; i < 50; ++i) line_W.emplace_back(0.001 * i, 0.0005 * i, 0.0);
  EXPECT_FALSE(FitQuadraticPatch(Pose::Identity(), line_W));
  EXPECT_FALSE(FitQuadraticPatch(Pose::Identity(), std::vector<Eigen::Vector3d>(50, Eigen::Vector3d::Zero())));
}

}  // namespace
}  // namespace nbs
