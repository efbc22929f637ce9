#include "services/planner/information_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/mapping/ray_walk.h"

namespace nbs {
namespace {

constexpr double kResolution = 0.005;

VoxelGrid MakeUnknownBox() {
  return VoxelGrid({Eigen::Vector3d::Constant(-0.1), kResolution, Eigen::Vector3i::Constant(40)});
}

/// A path that looks along `view_W` at the middle of the box from 0.3 m, `length` long across.
ScanPath MakePath(const Eigen::Vector3d& view_W, const Eigen::Vector3d& scan_W, double length) {
  const Eigen::Vector3d middle_W = -0.3 * view_W.normalized();
  ScanPath path;
  path.X_WS_start = MakeLookPose(middle_W - 0.5 * length * scan_W.normalized(), view_W, scan_W);
  path.X_WS_end = MakeLookPose(middle_W + 0.5 * length * scan_W.normalized(), view_W, scan_W);
  return path;
}

/// Random values, among them free, unknown and a few occupied cells.
VoxelGrid MakeMixedBox(uint64_t seed) {
  VoxelGrid grid = MakeUnknownBox();
  std::mt19937_64 engine(seed);
  for (int16_t& cell : grid.cells()) {
    const uint64_t draw = engine() % 100;
    if (draw < 50) cell = static_cast<int16_t>(static_cast<int>(engine() % 8000) - 5000);
    if (draw == 99) cell = 5000;
  }
  return grid;
}

ScanPath MakeRandomPath(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Eigen::Vector3d(normal(engine), normal(engine), normal(engine)).normalized(); };
  return MakePath(direction(), direction(), 0.1);
}

/// Eq. 2 written out: floating-point entropies, cell by cell.
double CalcByDefinition(const Profiler& profiler, const VoxelGrid& grid, const ScanPath& path) {
  double sum = 0.0;
  const int stripes = static_cast<int>(path.length_m() / 0.002 + 1e-6) + 1;
  for (int i = 0; i < stripes; ++i) {
    const Pose X_WS = Interpolate(path.X_WS_start, path.X_WS_end, i * 0.002 / path.length_m());
    for (int beam = 0; beam < profiler.points; ++beam) {
      const Eigen::Vector3d beam_S = CalcBeamDirection_S(profiler, beam);
      WalkRay(MakeRayWalk(grid.shape(), X_WS.translation(), X_WS * (beam_S * profiler.max_depth_m / beam_S.z())),
              [&](int64_t index) {
                const double p = CalcProbability(grid.cells()[index]);
                if (p >= 0.95) return false;
                sum += -p * std::log(p) - (1.0 - p) * std::log(1.0 - p);
                return true;
              });
    }
  }
  return sum;
}

TEST(InformationGain, IsTheSumOfEquation2) {
  const Profiler profiler;
  const InformationGain gain(profiler);
  std::mt19937_64 engine(1);
  for (int i = 0; i < 5; ++i) {
    const VoxelGrid grid = MakeMixedBox(i);
    const ScanPath path = MakeRandomPath(engine);
    const double expected = CalcByDefinition(profiler, grid, path);
    EXPECT_NEAR(ToNats(gain.Calc(GainMap(grid), path, kAllBeams)), expected, 1e-5 * expected + 1.0);
  }
}

TEST(InformationGain, OfAnUnknownBoxIsLn2PerCellFromEverySide) {
  // A nearly parallel fan straight through the box: each beam crosses 40 cells.
  Profiler profiler;
  profiler.fan_rad = 1e-6;
  const InformationGain gain(profiler);
  const VoxelGrid grid = MakeUnknownBox();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d view_W = sign * Eigen::Vector3d::Unit(axis), scan_W = Eigen::Vector3d::Unit((axis + 1) % 3);
      ScanPath path = MakePath(view_W, scan_W, 0.1);
      // Off the cells' faces.
      for (Pose* X_WS : {&path.X_WS_start, &path.X_WS_end}) X_WS->translation() += Eigen::Vector3d::Constant(0.0011);
      const double cells = 51.0 * 224.0 * 40.0;
      EXPECT_NEAR(ToNats(gain.Calc(GainMap(grid), path, kAllBeams)) / cells, std::numbers::ln2, 1e-5);
    }
  }
}

TEST(InformationGain, OfSpaceThatIsOutsideTheGridIsZero) {
  const InformationGain gain{Profiler{}};
  ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.1);
  for (Pose* X_WS : {&path.X_WS_start, &path.X_WS_end}) X_WS->translation().y() += 1.0;
  EXPECT_EQ(gain.Calc(GainMap(MakeUnknownBox()), path, kAllBeams), 0);
}

TEST(InformationGain, AWallOccludesWhatIsBehind) {
  const InformationGain gain{Profiler{}};
  const ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.1);
  VoxelGrid wall = MakeUnknownBox(), half = MakeUnknownBox();
  for (int z = 0; z < 40; ++z) {
    for (int x = 0; x < 40; ++x) {
      wall.cells()[wall.shape().Index(x, 0, z)] = 5000;
      for (int y = 20; y < 40; ++y) half.cells()[half.shape().Index(x, y, z)] = 5000;
    }
  }
  EXPECT_EQ(gain.Calc(GainMap(wall), path, kAllBeams), 0);
  EXPECT_GT(gain.Calc(GainMap(MakeUnknownBox()), path, kAllBeams), 0);
  // Nothing that stands behind the wall changes the sum.
  VoxelGrid wall_and_more = half;
  for (int z = 0; z < 40; ++z) {
    for (int x = 0; x < 40; ++x) wall_and_more.cells()[half.shape().Index(x, 30, z)] = -5000;
  }
  EXPECT_EQ(gain.Calc(GainMap(half), path, kAllBeams), gain.Calc(GainMap(wall_and_more), path, kAllBeams));
}

TEST(InformationGain, CountsUpToTheLargestDepthOfEachBeam) {
  // Every beam ends at the depth of 0.5 m, in the middle of layer 15.
  const Profiler profiler;
  const InformationGain gain(profiler);
  ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.0);
  path.X_WS_start.translation() = path.X_WS_end.translation() = Eigen::Vector3d(0.0011, -0.5225, 0.0011);
  const auto calc_with_unknown_layer = [&](int layer) {
    VoxelGrid grid = MakeUnknownBox();
    for (int z = 0; z < 40; ++z) {
      for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x)
          grid.cells()[grid.shape().Index(x, y, z)] = y == layer ? kUnobserved : int16_t{-32767};
      }
    }
    return ToNats(gain.Calc(GainMap(grid), path, kAllBeams));
  };
  int beams = 0;
  for (const Eigen::Vector3d& beam_S : CalcBeamDirections_S(profiler))
    beams += std::abs(beam_S.x() / beam_S.z()) < 0.19;
  EXPECT_GE(calc_with_unknown_layer(15), 0.999 * beams * std::numbers::ln2);
  EXPECT_EQ(calc_with_unknown_layer(16), 0.0);
}

TEST(InformationGain, NeverGrowsWhenACellGetsSurer) {
  const InformationGain gain{Profiler{}};
  std::mt19937_64 engine(2);
  const ScanPath path = MakeRandomPath(engine);
  VoxelGrid grid = MakeUnknownBox();
  int64_t before = gain.Calc(GainMap(grid), path, kAllBeams);
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 3000; ++i)
      grid.cells()[engine() % grid.cells().size()] = static_cast<int16_t>(-200 * round - 1);
    const int64_t after = gain.Calc(GainMap(grid), path, kAllBeams);
    EXPECT_LE(after, before);
    before = after;
  }
}

/// Beams of a path that meet an unknown cell before an occupied one, written out.
int64_t CountByDefinition(const Profiler& profiler, const VoxelGrid& grid, const ScanPath& path) {
  int64_t count = 0;
  const int stripes = static_cast<int>(path.length_m() / 0.002 + 1e-6) + 1;
  for (int i = 0; i < stripes; ++i) {
    const Pose X_WS = Interpolate(path.X_WS_start, path.X_WS_end, i * 0.002 / path.length_m());
    for (int beam = 0; beam < profiler.points; ++beam) {
      const Eigen::Vector3d beam_S = CalcBeamDirection_S(profiler, beam);
      WalkRay(MakeRayWalk(grid.shape(), X_WS.translation(), X_WS * (beam_S * profiler.max_depth_m / beam_S.z())),
              [&](int64_t index) {
                const double p = CalcProbability(grid.cells()[index]);
                if (p <= 0.3) return true;
                if (p < 0.95) ++count;
                return false;
              });
    }
  }
  return count;
}

TEST(InformationGain, UnderTheUnknownCountIsLn2PerBeamThatMeetsUnknownSpaceFirst) {
  const Profiler profiler;
  const InformationGain gain(profiler);
  std::mt19937_64 engine(8);
  VoxelGrid grid = MakeUnknownBox();
  for (int16_t& cell : grid.cells()) {
    const uint64_t draw = engine() % 100;
    cell = draw == 0 ? kUnobserved : draw == 1 ? int16_t{1000} : draw == 2 ? int16_t{5000} : int16_t{-4000};
  }
  const ScanPath path = MakeRandomPath(engine);
  const int64_t count = CountByDefinition(profiler, grid, path);
  EXPECT_GT(count, 1000);
  EXPECT_LT(count, gain.CountBeams(path));
  EXPECT_NEAR(ToNats(gain.Calc(GainMap(grid, GainRule::kUnknownCount), path, kAllBeams)),
              static_cast<double>(count) * std::numbers::ln2, 1e-5 * static_cast<double>(count));
}

TEST(InformationGain, CountsTheBeamsOfAllStripes) {
  const ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.1);
  EXPECT_EQ(InformationGain{Profiler{}}.CountBeams(path), 51 * 224);
}

TEST(InformationGain, DoesNotDependOnTheNumberOfThreads) {
  const InformationGain gain{Profiler{}};
  std::mt19937_64 engine(3);
  std::vector<ScanPath> paths;
  for (int i = 0; i < 9; ++i) paths.push_back(MakeRandomPath(engine));
  const VoxelGrid grid = MakeMixedBox(4);
  const std::vector<int64_t> one = gain.CalcAll(GainMap(grid), paths, kSixtyFourth, 1);
  for (const int threads : {2, 3, 20}) EXPECT_EQ(gain.CalcAll(GainMap(grid), paths, kSixtyFourth, threads), one);
  for (size_t i = 0; i < paths.size(); ++i) {
    for (const int threads : {1, 2, 3, 20})
      EXPECT_EQ(gain.Calc(GainMap(grid), paths[i], kSixtyFourth, threads), one[i]);
  }
}

TEST(InformationGain, OfASixtyFourthOfTheBeamsIsNearThatOfAll) {
  const InformationGain gain{Profiler{}};
  std::mt19937_64 engine(5);
  const VoxelGrid grid = MakeUnknownBox();
  for (int i = 0; i < 10; ++i) {
    const ScanPath path = MakeRandomPath(engine);
    const double all = ToNats(gain.Calc(GainMap(grid), path, kAllBeams));
    EXPECT_NEAR(ToNats(gain.Calc(GainMap(grid), path, kSixtyFourth)), all, 0.02 * all);
  }
}

TEST(InformationGain, CountsOneStripePerSpacingAndBothEnds) {
  const InformationGain gain{Profiler{}};
  const auto count = [&](double length) {
    return gain.CountStripes(MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), length));
  };
  EXPECT_EQ(count(0.0), 1);
  EXPECT_EQ(count(0.0019), 1);
  EXPECT_EQ(count(0.002), 2);
  EXPECT_EQ(count(0.1), 51);
  EXPECT_EQ(count(0.399), 200);
}

TEST(InformationGain, OfAStandingSensorIsThatOfOneStripe) {
  const InformationGain gain{Profiler{}};
  const ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.0);
  EXPECT_GT(gain.Calc(GainMap(MakeUnknownBox()), path, kAllBeams), 0);
  EXPECT_GT(gain.Calc(GainMap(MakeUnknownBox()), path, kSixtyFourth), 0);
}

TEST(InformationGain, FromInsideOfAnOccupiedCellIsZero) {
  const InformationGain gain{Profiler{}};
  VoxelGrid grid = MakeUnknownBox();
  ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.0);
  path.X_WS_start.translation() = path.X_WS_end.translation() = Eigen::Vector3d(0.0011, 0.0011, 0.0011);
  EXPECT_GT(gain.Calc(GainMap(grid), path, kAllBeams), 0);
  grid.cells()[FindCell(grid.shape(), path.X_WS_start.translation())] = 5000;
  EXPECT_EQ(gain.Calc(GainMap(grid), path, kAllBeams), 0);
}

TEST(InformationGain, IsTheSameWithEveryInstructionSet) {
  std::mt19937_64 engine(9);
  const GainMap map(MakeMixedBox(10));
  for (int i = 0; i < 5; ++i) {
    const ScanPath path = MakeRandomPath(engine);
    const int64_t portable = InformationGain(Profiler(), LaneSet::kSse42).Calc(map, path, kAllBeams);
    for (const LaneSet lanes : kLaneSets) {
      if (!IsSupported(lanes)) continue;
      EXPECT_EQ(InformationGain(Profiler(), lanes).Calc(map, path, kAllBeams), portable) << ToString(lanes);
    }
  }
}

TEST(InformationGain, RefusesStepsAndThreadsBelowOne) {
  const InformationGain gain{Profiler{}};
  const VoxelGrid grid = MakeUnknownBox();
  const ScanPath path = MakePath(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 0.0);
  EXPECT_THROW((void)gain.Calc(GainMap(grid), path, {0, 1}), std::invalid_argument);
  EXPECT_THROW((void)gain.Calc(GainMap(grid), path, {1, -1}), std::invalid_argument);
  EXPECT_THROW((void)gain.Calc(GainMap(grid), path, kAllBeams, 0), std::invalid_argument);
  EXPECT_THROW((void)gain.CalcAll(GainMap(grid), std::vector{path}, {0, 1}, 2), std::invalid_argument);
  EXPECT_THROW((void)gain.CalcAll(GainMap(grid), std::vector{path}, kAllBeams, 0), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
