#include "sim/simulated_profiler.h"

#include <gtest/gtest.h>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

Profiler MakeNoiseless() {
  Profiler profiler;
  profiler.sigma_base_m = 0.0;
  profiler.sigma_per_m = 0.0;
  return profiler;
}

/// Sensor at height `z` above the origin, looking straight down.
Pose MakeDownPose(double z) { return MakeLookPose({0.0, 0.0, z}, -Vector3d::UnitZ(), Vector3d::UnitY()); }

int CountReturns(const std::vector<float>& ranges_m) {
  return static_cast<int>(std::count_if(ranges_m.begin(), ranges_m.end(), [](float r) { return r > 0.0f; }));
}

/// A floor at z = 0 and a wall in the plane y = 0.04 that stands from z = 0.01 up to z = 0.2, beside the light plane y
/// = 0.
TriangleMesh MakeFloorAndWall() {
  TriangleMesh mesh = MakeSquare(1.0f, 0.0f);
  mesh.vertices_W.insert(mesh.vertices_W.end(),
                         {{-1, 0.04f, 0.01f}, {1, 0.04f, 0.01f}, {1, 0.04f, 0.2f}, {-1, 0.04f, 0.2f}});
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  return mesh;
}

TEST(SimulatedProfiler, PlaneIsMeasuredAsDepthOverCosine) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  const Profiler profiler = MakeNoiseless();
  const auto ranges = SimulatedProfiler(scene, profiler, 1).TakeProfile(MakeDownPose(0.3), 0, 0);
  ASSERT_EQ(ranges.size(), 224u);
  for (int i = 0; i < 224; ++i) EXPECT_NEAR(ranges[i], 0.3 / CalcBeamDirection_S(profiler, i).z(), 1e-6) << i;
}

TEST(SimulatedProfiler, SphereIsMeasuredAsTheQuadraticSays) {
  const TriangleScene scene(MakeSphere(0.1f, 7));
  const Profiler profiler = MakeNoiseless();
  const auto ranges = SimulatedProfiler(scene, profiler, 1).TakeProfile(MakeDownPose(0.4), 0, 0);
  int compared = 0;
  for (int i = 0; i < 224; ++i) {
    const double along = 0.4 * CalcBeamDirection_S(profiler, i).z();
    const double root = along * along - (0.16 - 0.01);
    if (root < 1e-4) continue;
    const double range = along - std::sqrt(root);
    const double cosine = (0.4 * CalcBeamDirection_S(profiler, i).z() - range) / 0.1;
    if (std::abs(cosine - std::cos(profiler.max_incidence_rad)) < 0.02) continue;
    ++compared;
    EXPECT_NEAR(ranges[i], cosine > std::cos(profiler.max_incidence_rad) ? range : 0.0, 5e-5) << i;
  }
  EXPECT_GT(compared, 100);
}

TEST(SimulatedProfiler, DepthOfFieldLimitsTheDepthNotTheRange) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  const SimulatedProfiler profiler(scene, MakeNoiseless(), 1);
  EXPECT_EQ(CountReturns(profiler.TakeProfile(MakeDownPose(0.1499), 0, 0)), 0);
  EXPECT_EQ(CountReturns(profiler.TakeProfile(MakeDownPose(0.1501), 0, 0)), 224);
  EXPECT_EQ(CountReturns(profiler.TakeProfile(MakeDownPose(0.4999), 0, 0)), 224);
  EXPECT_EQ(CountReturns(profiler.TakeProfile(MakeDownPose(0.5001), 0, 0)), 0);
}

TEST(SimulatedProfiler, SurfaceNearerThanTheDepthOfFieldBlocksTheBeam) {
  TriangleMesh mesh = MakeSquare(1.0f, 0.0f);
  for (const auto& p : MakeSquare(0.02f, 0.25f).vertices_W) mesh.vertices_W.push_back(p);
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  const TriangleScene scene(mesh);
  const auto ranges = SimulatedProfiler(scene, MakeNoiseless(), 1).TakeProfile(MakeDownPose(0.3), 0, 0);
  EXPECT_EQ(ranges[112], 0.0f);
  EXPECT_NEAR(ranges[0], 0.3 / std::cos(0.5 * Profiler().fan_rad), 1e-6);
}

TEST(SimulatedProfiler, BacksideGivesNoReturn) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  const Pose from_below = MakeLookPose({0.0, 0.0, -0.3}, Vector3d::UnitZ(), Vector3d::UnitY());
  EXPECT_EQ(CountReturns(SimulatedProfiler(scene, MakeNoiseless(), 1).TakeProfile(from_below, 0, 0)), 0);
}

TEST(SimulatedProfiler, DarkSurfaceBlocksAndGivesNoReturn) {
  const TriangleScene scene(MakeFloorAndWall());
  const Pose along_y = MakeLookPose({0.0, -0.3, 0.1}, Vector3d::UnitY(), Vector3d::UnitZ());
  EXPECT_GT(CountReturns(SimulatedProfiler(scene, MakeNoiseless(), 1).TakeProfile(along_y, 0, 0)), 200);
  EXPECT_EQ(CountReturns(SimulatedProfiler(scene, MakeNoiseless(), 1, 2).TakeProfile(along_y, 0, 0)), 0);
}

TEST(SimulatedProfiler, BeamsSteeperThanTheLargestIncidenceGiveNoReturn) {
  const TriangleScene scene(MakeSquare(2.0f, 0.0f));
  const Profiler profiler = MakeNoiseless();
  // The view is tilted in the fan's plane by 50 degrees: beam angles from the vertical are 50 - 25 ... 50 + 25 degrees.
  const double tilt = 50.0 * std::numbers::pi / 180.0;
  const Vector3d view(std::sin(tilt), 0.0, -std::cos(tilt));
  const auto ranges =
      SimulatedProfiler(scene, profiler, 1).TakeProfile(MakeLookPose({0.0, 0.0, 0.15}, view, Vector3d::UnitY()), 0, 0);
  for (int i = 0; i < 224; ++i) {
    const Vector3d beam = MakeLookPose({0, 0, 0}, view, Vector3d::UnitY()).linear() * CalcBeamDirection_S(profiler, i);
    const double incidence = std::acos(-beam.z());
    const double depth = 0.15 / -beam.z() * CalcBeamDirection_S(profiler, i).z();
    if (depth < 0.1501 || depth > 0.4999 || std::abs(incidence - profiler.max_incidence_rad) < 1e-4) continue;
    EXPECT_EQ(ranges[i] > 0.0f, incidence < profiler.max_incidence_rad) << i;
  }
  EXPECT_GT(CountReturns(ranges), 100);
  EXPECT_LT(CountReturns(ranges), 210);
}

TEST(SimulatedProfiler, PointTheCameraCannotSeeGivesNoReturn) {
  const TriangleScene scene(MakeFloorAndWall());
  Profiler profiler = MakeNoiseless();
  const Pose X_WS = MakeDownPose(0.3);
  EXPECT_EQ(CountReturns(SimulatedProfiler(scene, profiler, 1).TakeProfile(X_WS, 0, 0)), 224);
  profiler.camera_baseline_m = 0.12;
  EXPECT_EQ(CountReturns(SimulatedProfiler(scene, profiler, 1).TakeProfile(X_WS, 0, 0)), 0);
  profiler.camera_baseline_m = -0.12;
  EXPECT_EQ(CountReturns(SimulatedProfiler(scene, profiler, 1).TakeProfile(X_WS, 0, 0)), 224);
}

TEST(SimulatedProfiler, CameraBehindTheSurfaceSeesNothing) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  Profiler profiler = MakeNoiseless();
  profiler.camera_baseline_m = 0.5;
  // The light plane is tilted so far that the camera, 0.5 m along y, hangs below the floor.
  const double tilt = 45.0 * std::numbers::pi / 180.0;
  const Vector3d view(0.0, std::sin(tilt), -std::cos(tilt));
  const Pose X_WS = MakeLookPose({0.0, 0.0, 0.2}, view, Vector3d(0, -1, -1));
  EXPECT_LT((X_WS * Vector3d(0, 0.5, 0)).z(), 0.0);
  EXPECT_EQ(CountReturns(SimulatedProfiler(scene, profiler, 1).TakeProfile(X_WS, 0, 0)), 0);
}

TEST(SimulatedProfiler, NoiseHasTheStatedMeanAndDeviation) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  const Profiler profiler;
  const SimulatedProfiler simulated(scene, profiler, 7);
  const double sigma = CalcRangeSigma(profiler, 0.4);
  double sum = 0.0, squares = 0.0;
  for (int stripe = 0; stripe < 400; ++stripe) {
    const auto ranges = simulated.TakeProfile(MakeDownPose(0.4), 3, stripe);
    for (int i = 0; i < 224; ++i) {
      const double error = (ranges[i] - 0.4 / CalcBeamDirection_S(profiler, i).z()) / sigma;
      sum += error;
      squares += error * error;
    }
  }
  const double n = 400.0 * 224.0;
  EXPECT_NEAR(sum / n, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 4.0 * std::sqrt(2.0 / n));
}

TEST(SimulatedProfiler, SameKeysGiveSameBitsWhateverWasTakenBefore) {
  const TriangleScene scene(MakeSphere(0.1f, 4));
  const SimulatedProfiler first(scene, Profiler(), 5);
  const SimulatedProfiler second(scene, Profiler(), 5);
  second.TakeProfile(MakeDownPose(0.3), 1, 1);
  const auto ranges = first.TakeProfile(MakeDownPose(0.35), 2, 9);
  EXPECT_EQ(ranges, second.TakeProfile(MakeDownPose(0.35), 2, 9));
  EXPECT_NE(ranges, second.TakeProfile(MakeDownPose(0.35), 2, 8));
  EXPECT_NE(ranges, SimulatedProfiler(scene, Profiler(), 6).TakeProfile(MakeDownPose(0.35), 2, 9));
}

}  // namespace
}  // namespace nbs
