#include "sim/oracle/scan_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

const OracleBody kBody = {{{{0.0, 0.0, -0.04}, 0.04}}, std::nullopt};

/// A path along x at height z that looks down; the body's lowest point is at that height.
ScanPath MakePathAbove(double z, double from_x, double to_x) {
  return {MakeLookPose({from_x, 0.0, z}, -Vector3d::UnitZ(), Vector3d::UnitX()),
          MakeLookPose({to_x, 0.0, z}, -Vector3d::UnitZ(), Vector3d::UnitX())};
}

class RandomScanPaths : public ::testing::Test {
 protected:
  std::vector<ScanPath> Make(const OraclePathSettings& settings, const OracleBody& body = kBody) const {
    return MakeRandomScanPaths(scene_, samples_, body, settings);
  }

  const TriangleMesh sphere_ = MakeSphere(0.1f, 4);
  const TriangleScene scene_{sphere_};
  const std::vector<SurfaceSample> samples_ = MakeSurfaceSamples(sphere_, 5000);
};

TEST_F(RandomScanPaths, AreWhatTheSettingsSay) {
  OraclePathSettings settings;
  settings.count = 300;
  for (const ScanPath& path : Make(settings)) {
    EXPECT_LT(CalcAngleBetween(path.X_WS_start, path.X_WS_end), 1e-7);
    EXPECT_GE(path.length_m(), settings.min_length_m - 1e-9);
    EXPECT_LE(path.length_m(), settings.max_length_m + 1e-9);
    const Vector3d along = path.X_WS_end.translation() - path.X_WS_start.translation();
    EXPECT_NEAR(along.dot(path.X_WS_start.linear().col(1)), path.length_m(), 1e-9);
    // From the middle, the line of sight meets the sphere at the stand-off, no more oblique than the tilt (and what the
    // sphere's facets add).
    const Vector3d middle = 0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation());
    const RayHit hit = scene_.CastRay({middle, path.X_WS_start.linear().col(2)}, 1.0);
    ASSERT_TRUE(hit.hit());
    EXPECT_GE(hit.distance_m, settings.min_standoff_m - 1e-4);
    EXPECT_LE(hit.distance_m, settings.max_standoff_m + 1e-4);
    EXPECT_GE(-hit.normal_W.dot(path.X_WS_start.linear().col(2)), std::cos(settings.max_tilt_rad) - 1e-3);
  }
}

TEST_F(RandomScanPaths, KeepTheBodyClearAllAlong) {
  OraclePathSettings settings;
  settings.count = 200;
  settings.clearance_m = 0.15;  // Cuts into the range of stand-offs.
  for (const ScanPath& path : Make(settings)) {
    for (int step = 0; step <= 1000; ++step) {
      const Vector3d center = Interpolate(path.X_WS_start, path.X_WS_end, step / 1000.0) * Vector3d(0.0, 0.0, -0.04);
      // The facets lie a little inside of the sphere.
      ASSERT_GE(center.norm() - 0.1, 0.04 + settings.clearance_m - 1e-6);
    }
  }
}

TEST_F(RandomScanPaths, StayAboveTheTable) {
  OraclePathSettings settings;
  settings.count = 200;
  OracleBody body = kBody;
  body.table_z_m = -0.1;
  for (const ScanPath& path : Make(settings, body)) {
    for (const Pose& X_WS : {path.X_WS_start, path.X_WS_end}) {
      EXPECT_GE((X_WS * Vector3d(0.0, 0.0, -0.04)).z(), -0.1 + 0.04 + settings.clearance_m);
    }
  }
}

TEST_F(RandomScanPaths, FewerAreTheFirstOfMore) {
  OraclePathSettings settings;
  settings.count = 50;
  const auto more = Make(settings);
  settings.count = 20;
  const auto fewer = Make(settings);
  ASSERT_EQ(fewer.size(), 20u);
  for (size_t i = 0; i < fewer.size(); ++i) {
    EXPECT_EQ(fewer[i].X_WS_start.matrix(), more[i].X_WS_start.matrix());
    EXPECT_EQ(fewer[i].X_WS_end.matrix(), more[i].X_WS_end.matrix());
  }
  settings.seed = 2;
  EXPECT_NE(Make(settings)[0].X_WS_start.matrix(), fewer[0].X_WS_start.matrix());
}

TEST_F(RandomScanPaths, WithoutRoomAreRefused) {
  OraclePathSettings settings;
  settings.clearance_m = 0.5;
  EXPECT_THAT([&] { Make(settings); }, ::testing::Throws<std::invalid_argument>());
  EXPECT_THAT([&] { MakeRandomScanPaths(scene_, {}, kBody, {}); }, ::testing::Throws<std::invalid_argument>());
}

TEST(KeepsClear, OfASmallObstacleInTheMiddleOfTheWay) {
  // 4 mm wide, in the middle of 600 mm: nothing that steps along the path may pass over it.
  const TriangleScene needle(MakeSquare(0.002f, 0.0f));
  EXPECT_FALSE(KeepsClear(needle, MakePathAbove(0.079, -0.3, 0.3), kBody, 0.08));
  EXPECT_TRUE(KeepsClear(needle, MakePathAbove(0.081, -0.3, 0.3), kBody, 0.08));
  EXPECT_TRUE(KeepsClear(needle, MakePathAbove(0.0, 0.2, 0.8), kBody, 0.08));
}

TEST(KeepsClear, OfTheTable) {
  const TriangleScene nothing(TriangleMesh{});
  OracleBody body = kBody;
  EXPECT_TRUE(KeepsClear(nothing, MakePathAbove(0.07, 0.0, 0.5), body, 0.08));
  body.table_z_m = 0.0;
  EXPECT_FALSE(KeepsClear(nothing, MakePathAbove(0.07, 0.0, 0.5), body, 0.08));
  EXPECT_TRUE(KeepsClear(nothing, MakePathAbove(0.09, 0.0, 0.5), body, 0.08));
}

}  // namespace
}  // namespace nbs
