#include "services/planner/surface_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>

#include "services/planner/surface_view.h"
#include "tests/services/planner/half_seen_ball.h"
#include "tests/services/planner/synthetic_mesh.h"

namespace nbs {
namespace {

double CalcArea(const SurfacePrediction& prediction) {
  double area_m2 = 0.0;
  for (const SurfaceElement& element : prediction.elements()) area_m2 += element.area_m2;
  return area_m2;
}

SurfacePrediction Predict(const HalfSeenBall& ball) {
  SurfacePrediction prediction(ball.voxels.shape());
  prediction.Update(ball.voxels, ball.mesh);
  return prediction;
}

/// A pass under the ball, looking up at it.
ScanPath MakePathBelow() {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), along = Eigen::Vector3d::UnitY();
  return {MakeLookPose({0.0, -0.1, -0.325}, up, along), MakeLookPose({0.0, 0.1, -0.325}, up, along)};
}

TEST(SurfacePrediction, NothingIsForetoldFromNothing) {
  const VoxelGrid voxels({Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i::Constant(20)});
  SurfacePrediction prediction(voxels.shape());
  prediction.Update(voxels, {});
  EXPECT_TRUE(prediction.elements().empty());
}

TEST(SurfacePrediction, AHalfSeenBallIsClosedBelow) {
  const SurfacePrediction prediction = Predict(HalfSeenBall());
  int below = 0;
  for (const SurfaceElement& element : prediction.elements()) {
    EXPECT_LT(element.p_W.z(), 0.02f);
    EXPECT_NEAR(element.normal_W.norm(), 1.0f, 1e-4f);
    below += element.normal_W.z() < -0.7f;
  }
  // Even a flat bottom, without what is near the measured rim, is as large as 64 faces of a block.
  EXPECT_GT(below, 45);
  EXPECT_GT(CalcArea(prediction), 0.0045);
  EXPECT_LT(CalcArea(prediction), 0.060);
}

TEST(SurfacePrediction, KnownFreeSpaceHoldsNoSurface) {
  const HalfSeenBall ball;
  const SurfacePrediction prediction = Predict(ball);
  for (const SurfaceElement& element : prediction.elements()) {
    const int64_t cell = FindCell(ball.voxels.shape(), element.p_W.cast<double>());
    ASSERT_GE(cell, 0);
    const int16_t log_odds = ball.voxels.cells()[cell];
    EXPECT_TRUE(log_odds == kUnobserved || log_odds > CalcLogOdds(0.3)) << element.p_W.transpose();
  }
}

TEST(SurfacePrediction, TheMoreIsSeenTheLessIsForetold) {
  const double half = CalcArea(Predict(HalfSeenBall(1.57))), most = CalcArea(Predict(HalfSeenBall(2.5)));
  EXPECT_LT(most, 0.6 * half);
}

TEST(SurfacePrediction, AlongTheBorderTheSurfaceGoesOn) {
  const VoxelGrid voxels({Eigen::Vector3d::Constant(-0.05), 0.005, Eigen::Vector3i::Constant(40)});
  SurfacePredictionSettings settings;
  settings.max_rim_share = 1e3;
  SurfacePrediction prediction(voxels.shape(), settings);
  prediction.Update(voxels, MakePlaneMesh(21, 11));
  double area_m2 = 0.0;
  for (const SurfaceElement& element : prediction.elements()) {
    const bool is_rim = std::abs(element.p_W.z()) < 1e-6f;
    if (!is_rim) continue;
    area_m2 += element.area_m2;
    EXPECT_GT(element.normal_W.z(), 0.99f);
    const bool outside =
        element.p_W.x() < 0 || element.p_W.y() < 0 || element.p_W.x() > 0.06f || element.p_W.y() > 0.03f;
    EXPECT_TRUE(outside) << element.p_W.transpose();
  }
  EXPECT_NEAR(area_m2, 2.0 * (0.060 + 0.030) * 0.008, 1e-6);
}

TEST(SurfacePrediction, TheBorderInABlockIsWorthAShareOfItsFaceAtMost) {
  const VoxelGrid voxels({Eigen::Vector3d::Constant(-0.05), 0.005, Eigen::Vector3i::Constant(40)});
  SurfacePredictionSettings settings;
  settings.max_rim_share = 0.05;
  SurfacePrediction prediction(voxels.shape(), settings);
  prediction.Update(voxels, MakePlaneMesh(21, 11));
  std::map<uint32_t, double> by_block_m2;
  for (const SurfaceElement& element : prediction.elements()) {
    if (std::abs(element.p_W.z()) < 1e-6f) by_block_m2[element.block] += element.area_m2;
  }
  ASSERT_FALSE(by_block_m2.empty());
  for (const auto& [block, area_m2] : by_block_m2) EXPECT_LE(area_m2, 0.05 * 25e-6 * 1.001);
}

TEST(SurfacePrediction, ALookInVainIsHeldAgainstLooksFromThereMoreThanFromElsewhere) {
  const HalfSeenBall ball;
  SurfacePrediction prediction = Predict(ball);
  const ScanPath below = MakePathBelow();
  const std::vector<Sighting> seen = SurfaceView(Profiler()).FindSeen(prediction, below);
  ASSERT_FALSE(seen.empty());
  const SurfaceElement element = prediction.elements()[seen.front().element];
  const Eigen::Vector3f up_W = Eigen::Vector3f::UnitZ(), along_W = seen.front().beam_W;
  const Eigen::Vector3f across_W = along_W.cross(Eigen::Vector3f::UnitX());
  EXPECT_EQ(prediction.CalcTrust(element, along_W), 1.0f);
  prediction.AddScan(ball.voxels, Profiler(), below);
  EXPECT_NEAR(prediction.CalcTrust(element, along_W), 0.1f, 0.02f);  // Other elements of the block lie a little aside.
  EXPECT_NEAR(prediction.CalcTrust(element, across_W), 0.8f, 0.01f);
  EXPECT_NEAR(prediction.CalcTrust(element, -up_W), 0.8f, 0.01f);
  prediction.AddScan(ball.voxels, Profiler(), below);
  EXPECT_NEAR(prediction.CalcTrust(element, across_W), 0.64f, 0.02f);
}

TEST(SurfacePrediction, ALookInVainPushesThePredictedSurfaceBack) {
  const HalfSeenBall ball;
  const auto lowest = [](const SurfacePrediction& prediction) {
    float z = 1.0f;
    for (const SurfaceElement& element : prediction.elements()) z = std::min(z, element.p_W.z());
    return z;
  };
  SurfacePrediction prediction = Predict(ball);
  const float before = lowest(prediction);
  prediction.AddScan(ball.voxels, Profiler(), MakePathBelow());
  prediction.Update(ball.voxels, ball.mesh);
  EXPECT_GT(lowest(prediction), before + 0.005f);
}

TEST(SurfacePrediction, RoomIsTheDistanceToTheNearestWall) {
  const SurfacePrediction prediction = Predict(HalfSeenBall());
  const Eigen::Vector3i size = prediction.shape().size;
  std::vector<Eigen::Vector3i> walls, all;
  for (int z = 1; z + 1 < size.z(); ++z) {
    for (int y = 1; y + 1 < size.y(); ++y) {
      for (int x = 1; x + 1 < size.x(); ++x) {
        all.emplace_back(x, y, z);
        if (prediction.room()[prediction.shape().Index(x, y, z)] == 0) walls.emplace_back(x, y, z);
      }
    }
  }
  ASSERT_FALSE(walls.empty());
  for (const Eigen::Vector3i& block : all) {
    int nearest = SurfacePrediction::kMaxRoom;
    for (const Eigen::Vector3i& wall : walls) nearest = std::min(nearest, (wall - block).cwiseAbs().maxCoeff());
    ASSERT_EQ(prediction.room()[prediction.shape().Index(block.x(), block.y(), block.z())], nearest);
  }
}

TEST(SurfacePrediction, TheSameRoundsGiveTheSame) {
  const HalfSeenBall ball;
  SurfacePrediction a = Predict(ball), b = Predict(ball);
  for (SurfacePrediction* each : {&a, &b}) {
    each->AddScan(ball.voxels, Profiler(), MakePathBelow());
    each->Update(ball.voxels, ball.mesh);
  }
  EXPECT_TRUE(std::ranges::equal(a.potential(), b.potential()));
  ASSERT_EQ(a.elements().size(), b.elements().size());
}

TEST(SurfacePrediction, ThreadsChangeNothing) {
  const HalfSeenBall ball;
  const SurfacePrediction one = Predict(ball);
  for (const int threads : {2, 3, 100}) {
    SurfacePrediction more(ball.voxels.shape());
    more.Update(ball.voxels, ball.mesh, threads);
    EXPECT_TRUE(std::ranges::equal(one.potential(), more.potential())) << threads;
  }
}

TEST(SurfacePrediction, BlocksAreAsLargeInAFinerGrid) {
  const GridShape coarse{Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i(40, 30, 20)};
  const GridShape fine{Eigen::Vector3d::Zero(), 0.0025, Eigen::Vector3i(80, 60, 40)};
  EXPECT_EQ(SurfacePrediction(fine).shape(), SurfacePrediction(coarse).shape());
  const GridShape rough{Eigen::Vector3d::Zero(), 0.025, Eigen::Vector3i(8, 6, 4)};
  EXPECT_EQ(SurfacePrediction(rough).shape().resolution_m, 0.025);
}

TEST(SurfacePrediction, SettingsOutOfRangeAreRefused) {
  const GridShape shape{Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i::Constant(4)};
  EXPECT_THROW(SurfacePrediction(shape, {.block_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(SurfacePrediction(shape, {.relaxation = 2.0}), std::invalid_argument);
  EXPECT_THROW(SurfacePrediction(shape, {.missed_factor = 1.5}), std::invalid_argument);
  EXPECT_THROW(SurfacePrediction(shape, {.missed_elsewhere = -0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
