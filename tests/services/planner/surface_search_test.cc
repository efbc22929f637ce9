#include "services/planner/surface_search.h"

#include <gtest/gtest.h>

#include "tests/services/planner/half_seen_ball.h"

namespace nbs {
namespace {

class SurfaceSearch : public testing::Test {
 protected:
  SurfaceSearch() { prediction_.Update(ball_.voxels, ball_.mesh); }

  std::vector<ScanPath> Find(const SurfaceSearchSettings& settings = {}) const {
    return FindSurfacePaths(prediction_, view_, profiler_, HalfSeenBall::kVoxel_m, settings);
  }
  double CalcGain(const ScanPath& path) const { return view_.CalcGain(prediction_, path, HalfSeenBall::kVoxel_m); }

  HalfSeenBall ball_;
  SurfacePrediction prediction_{ball_.voxels.shape()};
  Profiler profiler_;
  SurfaceView view_{profiler_};
};

TEST_F(SurfaceSearch, TheBestPathLooksAtTheUnseenHalf) {
  const std::vector<ScanPath> paths = Find();
  ASSERT_FALSE(paths.empty());
  double all_nat = 0.0;
  for (const SurfaceElement& e : prediction_.elements()) all_nat += e.area_m2 / 25e-6 * 0.693147;
  EXPECT_GT(CalcGain(paths.front()), 0.3 * all_nat);
  const Eigen::Vector3d middle = 0.5 * (paths.front().X_WS_start.translation() + paths.front().X_WS_end.translation());
  EXPECT_LT(middle.z(), 0.0);
}

TEST_F(SurfaceSearch, PathsComeByFallingGainAndNoneIsWorthless) {
  for (const uint32_t step : {1u, 4u}) {
    SurfaceSearchSettings settings;
    settings.element_step = step;
    const std::vector<double> gains_nat = view_.CalcGains(prediction_, Find(settings), HalfSeenBall::kVoxel_m, 1, step);
    EXPECT_TRUE(std::ranges::is_sorted(gains_nat, std::ranges::greater())) << step;
  }
  const std::vector<ScanPath> paths = Find();
  EXPECT_GT(CalcGain(paths.back()), 0.0);
}

TEST_F(SurfaceSearch, NoTwoPathsAreAlikeAndThereAreNoMoreThanAskedFor) {
  SurfaceSearchSettings settings;
  settings.max_candidates = 20;
  const std::vector<ScanPath> paths = Find(settings);
  EXPECT_EQ(paths.size(), 20u);
  for (size_t i = 0; i < paths.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_FALSE(AreAlike(paths[i], paths[j], settings.alike_m, settings.alike_rad));
  }
}

TEST_F(SurfaceSearch, ImprovingNeverLoses) {
  SurfaceSearchSettings plain;
  plain.improve = 0;
  EXPECT_GE(CalcGain(Find().front()), CalcGain(Find(plain).front()));
}

TEST_F(SurfaceSearch, PathsKeepTheLimitsOfLengthAndDoNotTurn) {
  SurfaceSearchSettings settings;
  settings.limits = {.min_m = 0.05, .max_m = 0.25};
  for (const ScanPath& path : Find(settings)) {
    EXPECT_GE(path.length_m(), 0.05 - 1e-9);
    EXPECT_LE(path.length_m(), 0.25 + 1e-9);
    EXPECT_TRUE(IsRigid(path.X_WS_start));
    EXPECT_EQ(path.X_WS_start.linear(), path.X_WS_end.linear());
    EXPECT_NEAR((path.X_WS_end.translation() - path.X_WS_start.translation()).dot(path.X_WS_start.linear().col(2)), 0.0,
                1e-9);
  }
}

// A sensor whose camera sees nothing from one side: the better of two rolls is proposed.
TEST_F(SurfaceSearch, WithACameraBothRollsAreProposed) {
  const auto count_rolled = [](const std::vector<ScanPath>& paths) {
    int64_t rolled = 0;
    for (const ScanPath& a : paths) {
      rolled +=
          std::ranges::any_of(paths, [&](const ScanPath& b) { return a.X_WS_start.isApprox(RollPath(b).X_WS_start); });
    }
    return rolled;
  };
  EXPECT_EQ(count_rolled(Find()), 0);
  profiler_.camera_baseline_m = 0.12;
  view_ = SurfaceView(profiler_);
  const std::vector<ScanPath> paths = Find();
  EXPECT_GT(count_rolled(paths), 5);
  EXPECT_GE(CalcGain(paths.front()), CalcGain(RollPath(paths.front())));
}

TEST_F(SurfaceSearch, ThreadsChangeNothing) {
  SurfaceSearchSettings one;
  one.threads = 1;
  const std::vector<ScanPath> a = Find(one), b = Find();
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i].X_WS_start.isApprox(b[i].X_WS_start, 0.0));
}

TEST(SurfaceSearchAlone, WithoutAPredictionThereIsNothingToScan) {
  const SurfacePrediction prediction({Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i::Constant(10)});
  const Profiler profiler;
  EXPECT_TRUE(FindSurfacePaths(prediction, SurfaceView(profiler), profiler, 0.005).empty());
}

}  // namespace
}  // namespace nbs
