#include "services/planner/surface_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/services/planner/half_seen_ball.h"
#include "tests/services/planner/synthetic_mesh.h"

namespace nbs {
namespace {

constexpr double kVoxel_m = 0.005;

/// The strip around a plane of 60 x 30 mm in z = 0, in unknown space.
struct Plane {
  VoxelGrid voxels{{Eigen::Vector3d(-0.05, -0.05, -0.05), kVoxel_m, Eigen::Vector3i(40, 40, 60)}};
  SurfacePrediction prediction{voxels.shape()};

  Plane() { prediction.Update(voxels, MakePlaneMesh(21, 11)); }

  /// How many of the elements in the plane itself a path sees.
  int Count(const ScanPath& path, const Profiler& profiler = {}) const {
    int count = 0;
    for (const Sighting& seen : SurfaceView(profiler).FindSeen(prediction, path))
      count += std::abs(prediction.elements()[seen.element].p_W.z()) < 1e-6f;
    return count;
  }
  int CountAll() const {
    return static_cast<int>(std::ranges::count_if(prediction.elements(),
                                                  [](const SurfaceElement& e) { return std::abs(e.p_W.z()) < 1e-6f; }));
  }
};

/// Over the middle of the plane from y = -0.05 to y = 0.08, looking along `view_W`.
ScanPath MakePath(const Eigen::Vector3d& middle_W, const Eigen::Vector3d& view_W = -Eigen::Vector3d::UnitZ(),
                  double half_m = 0.065) {
  const Eigen::Vector3d along_W = Eigen::Vector3d::UnitY();
  return {MakeLookPose(middle_W - half_m * along_W, view_W, along_W),
          MakeLookPose(middle_W + half_m * along_W, view_W, along_W)};
}

const Eigen::Vector3d kAbove_W(0.03, 0.015, 0.325);

TEST(SurfaceView, APathOverThePlaneSeesItsWholeRim) {
  const Plane plane;
  ASSERT_EQ(plane.CountAll(), 60);
  EXPECT_EQ(plane.Count(MakePath(kAbove_W)), 60);
}

TEST(SurfaceView, APathThatEndsInTheMiddleSeesTheFirstPart) {
  const Plane plane;
  const ScanPath path = MakePath({0.03, -0.020, 0.325}, -Eigen::Vector3d::UnitZ(), 0.035);  // y from -0.055 to 0.015
  for (const Sighting& seen : SurfaceView(Profiler()).FindSeen(plane.prediction, path)) {
    const SurfaceElement& element = plane.prediction.elements()[seen.element];
    EXPECT_LE(element.p_W.y(), 0.0151f);
    EXPECT_NEAR((element.p_W - seen.beam_W).z(), 0.325f, 1e-6f);  // The emitter.
  }
  EXPECT_GT(plane.Count(path), 25);
  EXPECT_LT(plane.Count(path), 35);
}

TEST(SurfaceView, OutsideOfFanDepthAndIncidenceNothingIsSeen) {
  const Plane plane;
  EXPECT_EQ(plane.Count(MakePath({0.03 + 0.25, 0.015, 0.325})), 0) << "beside the fan";
  EXPECT_EQ(plane.Count(MakePath({0.03, 0.015, 0.140})), 0) << "too near";
  EXPECT_EQ(plane.Count(MakePath({0.03, 0.015, 0.510})), 0) << "too far";
  EXPECT_EQ(plane.Count(MakePath({0.03, 0.015, -0.325}, Eigen::Vector3d::UnitZ())), 0) << "from behind";
  const Eigen::Vector3d grazing(std::cos(0.3), 0.0, -std::sin(0.3));  // 73 degrees from the normal
  EXPECT_EQ(plane.Count(MakePath(Eigen::Vector3d(0.03, 0.015, 0.0) - 0.325 * grazing, grazing)), 0) << "grazing";
  EXPECT_EQ(plane.Count(MakePath(kAbove_W, -Eigen::Vector3d::UnitZ(), 0.0)), 0) << "a path of no length";
}

TEST(SurfaceView, AWallHidesWhatLiesBehind) {
  Plane plane;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) plane.voxels.cells()[plane.voxels.shape().Index(x, y, 45)] = 2 * kOccupiedLogOdds;
  }
  plane.prediction.Update(plane.voxels, MakePlaneMesh(21, 11));
  EXPECT_EQ(plane.Count(MakePath(kAbove_W)), 0);
}

TEST(SurfaceView, TheCameraMustSeeItToo) {
  Plane plane;
  // A wall in x and z beside the plane, which hides it from a camera at +y only.
  for (int x = 0; x < 40; ++x) {
    for (int z = 14; z < 60; ++z) plane.voxels.cells()[plane.voxels.shape().Index(x, 19, z)] = 2 * kOccupiedLogOdds;
  }
  plane.prediction.Update(plane.voxels, MakePlaneMesh(21, 11));
  Profiler with_camera;
  with_camera.camera_baseline_m = 0.12;
  EXPECT_EQ(plane.Count(MakePath(kAbove_W)), 60);
  EXPECT_LT(plane.Count(MakePath(kAbove_W), with_camera), 40);
}

TEST(SurfaceView, AnElementIsCountedOnceHoweverLongThePath) {
  const Plane plane;
  const SurfaceView view{Profiler()};
  const double exact = view.CalcGain(plane.prediction, MakePath(kAbove_W), kVoxel_m);
  const double longer = view.CalcGain(plane.prediction, MakePath(kAbove_W, -Eigen::Vector3d::UnitZ(), 0.3), kVoxel_m);
  EXPECT_DOUBLE_EQ(exact, longer);
}

TEST(SurfaceView, TheGainIsTheSeenAreaInVoxelFacesTimesLn2) {
  const HalfSeenBall ball;
  SurfacePrediction prediction(ball.voxels.shape());
  prediction.Update(ball.voxels, ball.mesh);
  const SurfaceView view{Profiler()};
  const ScanPath below = MakePath({0.0, 0.0, -0.325}, Eigen::Vector3d::UnitZ(), 0.1);
  double area_m2 = 0.0;
  for (const Sighting& seen : view.FindSeen(prediction, below)) area_m2 += prediction.elements()[seen.element].area_m2;
  ASSERT_GT(area_m2, 0.003);
  EXPECT_NEAR(view.CalcGain(prediction, below, kVoxel_m), area_m2 / 25e-6 * std::numbers::ln2, 1e-9);
}

TEST(SurfaceView, APathThatWasScannedInVainPromisesLittleAndOneFromElsewhereMore) {
  Plane plane;
  const SurfaceView view{Profiler()};
  const Eigen::Vector3d askew_W = Eigen::Vector3d(1.0, 0.0, -1.0).normalized();
  const ScanPath above = MakePath(kAbove_W);
  const ScanPath aside = MakePath(Eigen::Vector3d(0.03, 0.0, 0.0) - 0.325 * askew_W, askew_W);
  const double above_nat = view.CalcGain(plane.prediction, above, kVoxel_m);
  const double aside_nat = view.CalcGain(plane.prediction, aside, kVoxel_m);
  plane.prediction.AddScan(plane.voxels, Profiler(), above);
  EXPECT_LT(view.CalcGain(plane.prediction, above, kVoxel_m), 0.15 * above_nat);
  EXPECT_GT(view.CalcGain(plane.prediction, aside, kVoxel_m), 0.5 * aside_nat);
  EXPECT_LT(view.CalcGain(plane.prediction, aside, kVoxel_m), 0.8 * aside_nat);
}

TEST(SurfaceView, ThreadsChangeNothing) {
  const Plane plane;
  const SurfaceView view{Profiler()};
  std::vector<ScanPath> paths;
  for (int i = 0; i < 25; ++i) paths.push_back(MakePath(kAbove_W + Eigen::Vector3d(0.01 * i, 0.0, 0.0)));
  const std::vector<double> one = view.CalcGains(plane.prediction, paths, kVoxel_m, 1);
  EXPECT_EQ(one, view.CalcGains(plane.prediction, paths, kVoxel_m, 3));
  for (size_t i = 0; i < paths.size(); ++i) EXPECT_EQ(one[i], view.CalcGain(plane.prediction, paths[i], kVoxel_m));
}

}  // namespace
}  // namespace nbs
