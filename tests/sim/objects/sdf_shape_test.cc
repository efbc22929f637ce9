#include "sim/objects/sdf_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

Pose At(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Vector3d(x, y, z);
  return X;
}

Vector3d MakeRandomPoint(uint64_t i, double half) {
  return half *
         (2.0 * Vector3d(CalcUniform({1, i, 0}), CalcUniform({1, i, 1}), CalcUniform({1, i, 2})) - Vector3d::Ones());
}

TEST(Solids, DistanceOfABallIsExact) {
  EXPECT_NEAR(Ellipsoid{Vector3d::Constant(2.0)}.Distance({3, 4, 0}), 3.0, 1e-12);
  EXPECT_NEAR(Ellipsoid{Vector3d::Constant(2.0)}.Distance({0.5, 0, 0}), -1.5, 1e-12);
}

TEST(Solids, RoundConeTouchesTheBallsAtItsEnds) {
  const RoundCone cone{10.0, 3.0, 1.0};
  EXPECT_NEAR(cone.Distance({0, 0, -3}), 0.0, 1e-12);
  EXPECT_NEAR(cone.Distance({0, 0, 11}), 0.0, 1e-12);
  const double slope = 0.2;
  const Vector3d touch(std::sqrt(1.0 - slope * slope) * 3.0, 0.0, slope * 3.0);
  EXPECT_NEAR(cone.Distance(touch), 0.0, 1e-12);
}

TEST(Solids, TorusAndCylinderHaveTheirSurfacesWhereStated) {
  EXPECT_NEAR((Torus{5.0, 1.0}.Distance({6, 0, 0})), 0.0, 1e-12);
  EXPECT_NEAR((Torus{5.0, 1.0}.Distance({0, 5, 1})), 0.0, 1e-12);
  EXPECT_NEAR((Cylinder{5.0, 2.0, 0.5}.Distance({5, 0, 0})), 0.0, 1e-12);
  EXPECT_NEAR((Cylinder{5.0, 2.0, 0.5}.Distance({0, 0, 4})), 2.0, 1e-12);
}

TEST(Solids, BowlIsHollowAndOpenAtTheTop) {
  const Bowl bowl{10.0, 2.0, 1.0};
  EXPECT_GT(bowl.Distance({0, 0, 0}), 5.0);
  EXPECT_LT(bowl.Distance({0, 0, -10}), 0.0);
  EXPECT_GT(bowl.Distance({0, 0, 10}), 5.0);
}

TEST(SdfShape, SharpUnionIsTheNearerSolidAndACutTakesAway) {
  SdfShape shape;
  shape.Add(Ellipsoid{Vector3d::Constant(2.0)}, At(0, 0, 0), {});
  shape.Add(Ellipsoid{Vector3d::Constant(1.0)}, At(6, 0, 0), {});
  shape.Cut(Ellipsoid{Vector3d::Constant(0.5)}, At(0, 0, 0), {});
  const auto steps = shape.AllSteps();
  EXPECT_NEAR(shape.Evaluate({4, 0, 0}, steps), 1.0, 1e-12);
  EXPECT_NEAR(shape.Evaluate({0, 0, 0}, steps), 0.5, 1e-12);
  EXPECT_NEAR(shape.Evaluate({0, 1.25, 0}, steps), -0.75, 1e-12);
}

TEST(SdfShape, RoundedSeamAddsAQuarterOfItsWidthWhereSolidsMeet) {
  SdfShape shape;
  shape.Add(Ellipsoid{Vector3d::Constant(1.0)}, At(-2, 0, 0), {});
  shape.Add(Ellipsoid{Vector3d::Constant(1.0)}, At(2, 0, 0), {.blend = 0.8});
  EXPECT_NEAR(shape.Evaluate({0, 0, 0}, shape.AllSteps()), 0.8, 1e-12);
}

TEST(SdfShape, StepsThatAreLeftOutDoNotMoveTheSurface) {
  SdfShape shape;
  for (uint64_t i = 0; i < 60; ++i) {
    const SdfShape::Seam seam{
        .blend = 1.0 + static_cast<double>(i % 5), .ripple = i % 3 == 0 ? 0.4 : 0.0, .ripple_size = 3.0};
    const Pose X = At(MakeRandomPoint(i, 40).x(), MakeRandomPoint(i, 40).y(), MakeRandomPoint(i, 40).z());
    const Vector3d half_axes(5.0 + 0.1 * static_cast<double>(i), 6.0, 7.0);
    i % 7 == 6 ? shape.Cut(Ellipsoid{half_axes}, X, seam) : shape.Add(Ellipsoid{half_axes}, X, seam);
  }
  const auto all = shape.AllSteps();
  size_t kept = 0;
  for (uint64_t i = 0; i < 4000; ++i) {
    const Vector3d middle = MakeRandomPoint(1000 + i, 50);
    const auto steps = shape.FindSteps(middle, 3.0, all);
    kept += steps.size();
    const Vector3d p = middle + 1.7 * MakeRandomPoint(9000 + i, 1.0);
    const double exact = shape.Evaluate(p, all);
    const double local = shape.Evaluate(p, steps);
    EXPECT_EQ(exact < 0.0, local < 0.0) << i;
    if (std::abs(exact) < 0.2) {
      EXPECT_NEAR(local, exact, 1e-9) << i;
    }
  }
  EXPECT_LT(kept, 4000u * 20u);
}

TEST(SdfShape, SlopeIsTheGradient) {
  SdfShape shape;
  shape.Add(Torus{5.0, 1.0}, At(1, 2, 3), {});
  const Vector3d p(7.0, 4.0, 3.5);
  const auto slope = shape.CalcSlope(p, shape.AllSteps(), 1e-6);
  EXPECT_NEAR(slope.gradient.norm(), 1.0, 1e-5);
  EXPECT_NEAR(shape.Evaluate(p - slope.distance * slope.gradient, shape.AllSteps()), 0.0, 1e-5);
}

}  // namespace
}  // namespace nbs
