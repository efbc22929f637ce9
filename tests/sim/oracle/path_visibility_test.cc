#include "sim/oracle/path_visibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/simulated_profiler.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// A path in the direction of y, of the given length, that looks down from height z.
ScanPath MakeDownPath(double z, double length, double x = 0.0) {
  const auto pose = [&](double y) { return MakeLookPose({x, y, z}, -Vector3d::UnitZ(), Vector3d::UnitY()); };
  return {pose(-0.5 * length), pose(0.5 * length)};
}

/// A path above two spheres, the smaller one in front of a part of the larger, seen aslant.
ScanPath MakeSlantedPath() {
  const Vector3d view = Vector3d(0.2, 0.1, -1.0).normalized();
  const Vector3d along = Vector3d(0.3, 1.0, 0.1).normalized();
  return {MakeLookPose({-0.05, -0.15, 0.42}, view, along),
          MakeLookPose(Vector3d(-0.05, -0.15, 0.42) + 0.3 * along, view, along)};
}

TriangleMesh MakeTwoSpheres() {
  TriangleMesh mesh = MakeSphere(0.1f, 5);
  const TriangleMesh small = MakeSphere(0.03f, 4);
  const auto offset = static_cast<uint32_t>(mesh.vertices_W.size());
  for (const Eigen::Vector3f& p : small.vertices_W) mesh.vertices_W.emplace_back(p + Eigen::Vector3f(0, 0.02f, 0.17f));
  for (const auto& t : small.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return mesh;
}

TEST(PathVisibility, OfASquareIsTheRectangleThatTheFanSweeps) {
  const TriangleMesh square = MakeSquare(0.3f, 0.0f);
  const TriangleScene scene(square);
  const auto samples = MakeSurfaceSamples(square, 20000);
  const auto seen = PathVisibility(scene, samples, Profiler{}).FindSeen(MakeDownPath(0.3, 0.2));
  std::vector<uint32_t> expected;
  for (uint32_t i = 0; i < samples.size(); ++i) {
    const Vector3d& p = samples[i].p_W;
    if (std::abs(p.y()) <= 0.1 && std::abs(p.x()) <= 0.3 * std::tan(0.5 * Profiler{}.fan_rad)) expected.push_back(i);
  }
  EXPECT_GT(expected.size(), 1000u);
  EXPECT_EQ(seen, expected);
}

TEST(PathVisibility, EndsAtTheDepthOfFieldAndAtTheBackOfTheSurface) {
  const TriangleMesh square = MakeSquare(0.05f, 0.0f);
  const TriangleScene scene(square);
  const auto samples = MakeSurfaceSamples(square, 100);
  const PathVisibility visibility(scene, samples, Profiler{});
  EXPECT_EQ(visibility.FindSeen(MakeDownPath(0.16, 0.2)).size(), 100u);
  EXPECT_EQ(visibility.FindSeen(MakeDownPath(0.49, 0.2)).size(), 100u);
  EXPECT_TRUE(visibility.FindSeen(MakeDownPath(0.14, 0.2)).empty());
  EXPECT_TRUE(visibility.FindSeen(MakeDownPath(0.51, 0.2)).empty());
  const Pose from_below = MakeLookPose({0.0, -0.1, -0.3}, Vector3d::UnitZ(), Vector3d::UnitY());
  const Pose to_below = MakeLookPose({0.0, 0.1, -0.3}, Vector3d::UnitZ(), Vector3d::UnitY());
  EXPECT_TRUE(visibility.FindSeen({from_below, to_below}).empty());
}

TEST(PathVisibility, IsTheSameDrivenTheOtherWayAndRolledByHalfATurn) {
  const TriangleMesh mesh = MakeTwoSpheres();
  const TriangleScene scene(mesh);
  const auto samples = MakeSurfaceSamples(mesh, 5000);
  const PathVisibility visibility(scene, samples, Profiler{});
  const ScanPath path = MakeSlantedPath();
  const Pose half_turn(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()));
  const auto seen = visibility.FindSeen(path);
  EXPECT_GT(seen.size(), 500u);
  EXPECT_EQ(visibility.FindSeen({path.X_WS_end, path.X_WS_start}), seen);
  EXPECT_EQ(visibility.FindSeen({path.X_WS_end * half_turn, path.X_WS_start * half_turn}), seen);
}

TEST(PathVisibility, OfAPathInTwoPartsIsThatOfTheParts) {
  const TriangleMesh mesh = MakeTwoSpheres();
  const TriangleScene scene(mesh);
  const auto samples = MakeSurfaceSamples(mesh, 5000);
  const PathVisibility visibility(scene, samples, Profiler{});
  const ScanPath path = MakeSlantedPath();
  const Pose cut = Interpolate(path.X_WS_start, path.X_WS_end, 0.37);
  const auto first = visibility.FindSeen({path.X_WS_start, cut}), second = visibility.FindSeen({cut, path.X_WS_end});
  std::set<uint32_t> both(first.begin(), first.end());
  both.insert(second.begin(), second.end());
  EXPECT_THAT(visibility.FindSeen(path), ::testing::ElementsAreArray(both));
}

/// The closed form against the simulated profiler itself, with beams and stripes so dense that no sample falls between.
void CompareWithProfiler(const Profiler& cell_profiler) {
  const TriangleMesh mesh = MakeTwoSpheres();
  const TriangleScene scene(mesh);
  const auto samples = MakeSurfaceSamples(mesh, 4000);
  const ScanPath path = MakeSlantedPath();
  Profiler profiler = cell_profiler;
  profiler.points = 801;
  profiler.sigma_base_m = profiler.sigma_per_m = 0.0;
  const SimulatedProfiler simulated(scene, profiler, 1);
  const auto directions_S = CalcBeamDirections_S(profiler);
  std::vector<double> nearest_m(samples.size(), 1.0);
  for (int stripe = 0; stripe <= 600; ++stripe) {
    const Pose X_WS = Interpolate(path.X_WS_start, path.X_WS_end, stripe / 600.0);
    const auto ranges_m = simulated.TakeProfile(X_WS, 0, stripe);
    for (size_t i = 0; i < samples.size(); ++i) {
      const Vector3d p_SP = X_WS.inverse() * samples[i].p_W;
      // Only the beam next to the sample can come near it.
      const double angle = std::atan2(p_SP.x(), p_SP.z());
      const long beam = std::lround((angle / profiler.fan_rad + 0.5) * (profiler.points - 1));
      if (std::abs(p_SP.y()) > 0.002 || beam < 0 || beam >= profiler.points || ranges_m[beam] == 0.0f) continue;
      nearest_m[i] = std::min(nearest_m[i], (ranges_m[beam] * directions_S[beam] - p_SP).norm());
    }
  }
  std::vector<uint8_t> is_seen(samples.size(), 0);
  for (uint32_t i : PathVisibility(scene, samples, profiler).FindSeen(path)) is_seen[i] = 1;
  int seen = 0, missed = 0, invented = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    seen += is_seen[i];
    missed += is_seen[i] == 0 && nearest_m[i] < 0.0004;
    invented += is_seen[i] != 0 && nearest_m[i] > 0.0015;
  }
  // At shadows and rims a sample may be on the one side and the nearest beam on the other.
  EXPECT_GT(seen, 400);
  EXPECT_LE(missed, seen / 200);
  EXPECT_LE(invented, seen / 200);
}

TEST(PathVisibility, IsWhatTheProfilerMeasures) { CompareWithProfiler(Profiler{}); }

TEST(PathVisibility, IsWhatAProfilerWithACameraMeasures) {
  Profiler profiler;
  profiler.camera_baseline_m = 0.1;
  CompareWithProfiler(profiler);
}

TEST(PathVisibility, OfAPathAlongItsStripeIsNothing) {
  const TriangleMesh square = MakeSquare(0.3f, 0.0f);
  const TriangleScene scene(square);
  const auto samples = MakeSurfaceSamples(square, 100);
  const Pose start = MakeLookPose({0.0, 0.0, 0.3}, -Vector3d::UnitZ(), Vector3d::UnitY());
  Pose end = start;
  end.translation().x() = 0.1;
  EXPECT_TRUE(PathVisibility(scene, samples, Profiler{}).FindSeen({start, end}).empty());
}

TEST(PathVisibility, RefusesAPathThatTurns) {
  const TriangleMesh square = MakeSquare(0.3f, 0.0f);
  const TriangleScene scene(square);
  const auto samples = MakeSurfaceSamples(square, 100);
  const ScanPath path = {MakeLookPose({0.0, 0.0, 0.3}, -Vector3d::UnitZ(), Vector3d::UnitY()),
                         MakeLookPose({0.0, 0.1, 0.3}, Vector3d(0.0, 0.1, -1.0), Vector3d::UnitY())};
  EXPECT_THAT([&] { PathVisibility(scene, samples, Profiler{}).FindSeen(path); },
              ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
