#include "sim/solid_distance.h"

#include <gtest/gtest.h>

#include <random>

#include "common/kinematics/shape_distance.h"
#include "sim/closest_on_triangle.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

class SolidDistance : public ::testing::Test {
 protected:
  Vector3d Draw(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    return {u(random_), u(random_), u(random_)};
  }
  Pose DrawPose() {
    return MakePose(Draw(0.3), Eigen::Quaterniond(Eigen::AngleAxisd(Draw(3.0).x(), Draw(1.0).normalized())));
  }

  std::mt19937 random_{7};
};

/// Smallest distance of a fine grid of points of the triangle from something.
template <typename Distance>
double CalcByPoints(const std::array<Vector3d, 3>& t, const Distance& distance) {
  constexpr int kSteps = 60;
  double smallest = 1e9;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps - i; ++k)
      smallest = std::min(smallest, distance(t[0] + (t[1] - t[0]) * i / kSteps + (t[2] - t[0]) * k / kSteps));
  }
  return smallest;
}

TEST_F(SolidDistance, OfACapsuleFromATriangleAgreesWithPointsOfTheTriangle) {
  for (int trial = 0; trial < 300; ++trial) {
    const std::array<Vector3d, 3> t = {Draw(0.3), Draw(0.3), Draw(0.3)};
    const Capsule capsule{Draw(0.3), trial % 5 == 0 ? Vector3d(Vector3d::Zero()) : Draw(0.3), 0.05};
    const double by_points =
        CalcByPoints(t, [&](const Vector3d& p) { return CalcSegmentDistance(p, p, capsule.p_A, capsule.p_B) - 0.05; });
    const double exact = CalcTriangleDistance(capsule, t[0], t[1], t[2]);
    EXPECT_LE(exact, by_points + 1e-9);
    EXPECT_NEAR(exact, by_points, 0.012) << trial;
  }
}

TEST_F(SolidDistance, OfABoxFromATriangleAgreesWithPointsOfTheTriangle) {
  for (int trial = 0; trial < 300; ++trial) {
    const std::array<Vector3d, 3> t = {Draw(0.3), Draw(0.3), Draw(0.3)};
    const Block block{DrawPose(), Vector3d(0.02, 0.1, 0.06)};
    const Pose X_CW = block.X_LC.inverse();
    const double by_points = CalcByPoints(t, [&](const Vector3d& p) { return CalcBoxDistance(X_CW * p, block.half); });
    const double exact = CalcTriangleDistance(block, t[0], t[1], t[2]);
    EXPECT_LE(exact, by_points + 1e-9);
    EXPECT_NEAR(exact, by_points, 0.012) << trial;
  }
}

TEST_F(SolidDistance, FromAMeshIsThatOfTheNearestTriangleOrNoneWithinReach) {
  const TriangleMesh ball = MakeSphere(0.1f, 4);
  const TriangleScene scene(ball);
  int met = 0, far = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Capsule capsule{Draw(0.4), Draw(0.4), 0.03};
    double smallest = 1e9;
    for (const auto& t : ball.triangles)
      smallest = std::min(
          smallest, CalcTriangleDistance(capsule, ball.vertices_W[t[0]].cast<double>(),
                                         ball.vertices_W[t[1]].cast<double>(), ball.vertices_W[t[2]].cast<double>()));
    const auto found = FindDistance(capsule, scene, 0.1);
    ASSERT_EQ(found.has_value(), smallest < 0.1);
    EXPECT_DOUBLE_EQ(found.value_or(smallest), smallest);
    met += smallest < 0.0;
    far += !found;
  }
  EXPECT_GT(met, 10);
  EXPECT_GT(far, 10);
}

TEST_F(SolidDistance, OfTwoBoxesIsSymmetricAndZeroWhereTheyMeetOrOneHoldsTheOther) {
  const Block big{Pose::Identity(), Vector3d(0.5, 0.5, 0.5)};
  EXPECT_EQ(CalcBlockDistance(big, Block{DrawPose(), Vector3d(0.05, 0.05, 0.05)}), 0.0);
  const Block small{MakePose({0.8, 0, 0}, Eigen::Quaterniond::Identity()), Vector3d(0.1, 0.1, 0.1)};
  EXPECT_NEAR(CalcBlockDistance(big, small), 0.2, 1e-6);
  EXPECT_NEAR(CalcBlockDistance(small, big), 0.2, 1e-6);
}

TEST_F(SolidDistance, LowestPointOfATurnedBoxIsThatOfItsCorners) {
  const Block block{MakePose({0, 0, 1}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitX()))),
                    Vector3d(0.3, 0.1, 0.1)};
  EXPECT_NEAR(CalcLowest(block), 1.0 - 0.1 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(CalcLowest(Capsule{{0, 0, 1}, {0, 0, 2}, 0.1}), 0.9, 1e-12);
}

TEST_F(SolidDistance, PointIsInsideAClosedMeshOnly) {
  TriangleMesh ball = MakeSphere(0.1f, 3);
  EXPECT_TRUE(TriangleScene(ball).IsInside({0.02, 0.01, -0.03}));
  EXPECT_FALSE(TriangleScene(ball).IsInside({0.2, 0, 0}));
  std::erase_if(ball.triangles, [&](const auto& t) { return ball.vertices_W[t[0]].z() > 0.05f; });
  EXPECT_FALSE(TriangleScene(ball).IsInside({0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace nbs
