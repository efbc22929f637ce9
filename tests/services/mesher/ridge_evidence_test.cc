#include "services/mesher/ridge_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nbs {
namespace {

using Eigen::Vector3f;

constexpr float kSigma_m = 0.0001f;

/// A ridge along z that points to +y, of 90 degrees, rounded with the given radius: measured from z = -8 mm to 2 mm,
/// every 0.4 mm, from the side.
MeasurementMap MakeRidge(float rounding_m) {
  MeasurementMap map(0.002f);
  const float flat_m = rounding_m * std::tan(std::numbers::pi_v<float> / 8.0f);  // The arc ends so far from the ridge.
  for (float z = -0.008f; z < 0.002f; z += 0.0004f) {
    for (float along = -0.008f; along < 0.008f; along += 0.0004f) {
      const Vector3f down = Vector3f(along < 0.0f ? -1.0f : 1.0f, -1.0f, 0.0f).normalized();
      Vector3f p_W = std::abs(along) * down;
      if (std::abs(along) < flat_m) {
        const float angle = along / flat_m * std::numbers::pi_v<float> / 4.0f;
        p_W =
            Vector3f(rounding_m * std::sin(angle), rounding_m * (std::cos(angle) - std::numbers::sqrt2_v<float>), 0.0f);
      }
      p_W.z() = z;
      const Vector3f view_W = Vector3f(along < 0.0f ? -0.4f : 0.4f, 1.0f, 0.0f).normalized();
      map.Insert({p_W, view_W, kSigma_m}, view_W);
    }
  }
  return map;
}

Roof MakeRoof() {
  std::vector<Tangent> tangents;
  for (const float side : {-1.0f, 1.0f}) {
    for (const float z : {-0.004f, -0.002f, 0.0f}) {
      const Vector3f foot_W(side * 0.003f, -0.003f, z);
      tangents.push_back({foot_W, Vector3f(side, 1.0f, 0.0f).normalized()});
      tangents.push_back({foot_W + Vector3f(side * 0.001f, -0.001f, 0.0f), Vector3f(side, 1.0f, 0.0f).normalized()});
    }
  }
  return *Roof::Fit(tangents, Vector3f::Zero(), {});
}

bool IsMeasured(const MeasurementMap& map, float z_m) {
  RidgeEvidence evidence(map, {});
  const Roof roof = MakeRoof();
  return evidence.IsMeasured(roof, roof.FindFeet({0.0f, -0.0005f, z_m}).at(0));
}

TEST(RidgeEvidence, SharpRidgeIsMeasured) { EXPECT_TRUE(IsMeasured(MakeRidge(0.0f), -0.003f)); }

TEST(RidgeEvidence, RoundRidgeIsNotSharp) { EXPECT_FALSE(IsMeasured(MakeRidge(0.0025f), -0.003f)); }

TEST(RidgeEvidence, RidgeIsNotMeasuredBeyondItsEnd) { EXPECT_FALSE(IsMeasured(MakeRidge(0.0f), 0.0027f)); }

TEST(RidgeEvidence, NothingMeasuredIsNoEvidence) {
  const MeasurementMap empty(0.002f);
  EXPECT_FALSE(IsMeasured(empty, -0.003f));
  RidgeEvidence evidence(empty, {});
  EXPECT_FALSE(evidence.Carries(MakeRoof(), {Vector3f::Zero(), Vector3f::UnitY()}, true));
}

TEST(RidgeEvidence, MeasurementsOfASharpRidgeCarryItsRoof) {
  const MeasurementMap sharp = MakeRidge(0.0f), round = MakeRidge(0.004f);
  const Tangent at{{0.0f, -0.0005f, -0.003f}, Vector3f::UnitY()};
  EXPECT_TRUE(RidgeEvidence(sharp, {}).Carries(MakeRoof(), at, false));
  EXPECT_FALSE(RidgeEvidence(round, {}).Carries(MakeRoof(), at, true));
}

}  // namespace
}  // namespace nbs
