#include "common/sensing/profiler.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nbs {
namespace {

using Eigen::Vector3d;

void ExpectNear(const Vector3d& a, const Vector3d& b) { EXPECT_LT((a - b).norm(), 1e-9) << a.transpose(); }

/// 50 degrees in all: sin 25° = 0.4226182617, cos 25° = 0.9063077870.
TEST(BeamDirection, FirstBeamLooksTowardsMinusXAndTheLastTowardsPlusXAtHalfTheFan) {
  const Profiler profiler;
  ExpectNear(CalcBeamDirection_S(profiler, 0), {-0.4226182617, 0.0, 0.9063077870});
  ExpectNear(CalcBeamDirection_S(profiler, 223), {0.4226182617, 0.0, 0.9063077870});
}

TEST(BeamDirection, MiddleBeamOfAnOddNumberIsTheViewingAxis) {
  Profiler profiler;
  profiler.points = 5;
  ExpectNear(CalcBeamDirection_S(profiler, 2), Vector3d::UnitZ());
}

/// With four beams one at each third of 50°: -25, -8.333, 8.333, 25.
TEST(BeamDirection, BeamsFanOutEvenlyInAngle) {
  Profiler profiler;
  profiler.points = 4;
  ExpectNear(CalcBeamDirection_S(profiler, 1), {-0.1449318593, 0.0, 0.9894416385});
  ExpectNear(CalcBeamDirection_S(profiler, 2), {0.1449318593, 0.0, 0.9894416385});
}

/// 2 * 0.325 m * tan 25°.
TEST(BeamDirection, StripeIs303MillimetresWideAtTheWorkingDistance) {
  const Profiler profiler;
  const auto directions_S = CalcBeamDirections_S(profiler);
  ASSERT_EQ(directions_S.size(), 224u);
  const auto at_standoff = [&](const Vector3d& d) { return Vector3d(d * profiler.standoff_m / d.z()); };
  const Vector3d across = at_standoff(directions_S.back()) - at_standoff(directions_S.front());
  EXPECT_NEAR(across.x(), 0.3031, 1e-6);
  ExpectNear(across.cwiseProduct(Vector3d(0, 1, 1)), Vector3d::Zero());
}

TEST(BeamDirection, AllOfThemAreThoseOfTheSingleBeams) {
  const Profiler profiler;
  const auto directions_S = CalcBeamDirections_S(profiler);
  for (int i = 0; i < profiler.points; ++i) EXPECT_EQ(directions_S[i], CalcBeamDirection_S(profiler, i)) << i;
}

TEST(BeamDirection, ABeamThatIsNotThereIsRefused) {
  EXPECT_THROW(CalcBeamDirection_S(Profiler{}, -1), std::invalid_argument);
  EXPECT_THROW(CalcBeamDirection_S(Profiler{}, 224), std::invalid_argument);
}

/// 0.05 mm + 2.0e-3/m z^2.
TEST(RangeSigma, GrowsWithTheSquareOfTheDepth) {
  const Profiler profiler;
  EXPECT_DOUBLE_EQ(CalcRangeSigma(profiler, 0.150), 0.095e-3);
  EXPECT_DOUBLE_EQ(CalcRangeSigma(profiler, 0.500), 0.55e-3);
  EXPECT_DOUBLE_EQ(CalcRangeSigma(profiler, 0.0), 0.05e-3);
}

/// The nominal scan direction is +y: a sensor that moves there has its camera ahead of the light plane.
TEST(Camera, StandsOnTheSideOfPlusYOfTheLightPlane) {
  Profiler profiler;
  EXPECT_FALSE(profiler.HasCamera());
  EXPECT_EQ(CalcCamera_S(profiler), Vector3d::Zero());
  profiler.camera_baseline_m = 0.12;
  EXPECT_TRUE(profiler.HasCamera());
  EXPECT_EQ(CalcCamera_S(profiler), Vector3d(0.0, 0.12, 0.0));
}

}  // namespace
}  // namespace nbs
