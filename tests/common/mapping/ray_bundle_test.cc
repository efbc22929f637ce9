#include "common/mapping/ray_bundle.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "common/mapping/ray_walk.h"

namespace nbs {
namespace {

GridShape MakeShape() { return {Eigen::Vector3d(-0.1, 0.05, -0.2), 0.005, Eigen::Vector3i(40, 31, 57)}; }

/// Fans as a profiler has them: from inside and outside of the box, along the axes and across them.
struct Fan {
  Eigen::Vector3d p_WA;
  std::vector<Eigen::Vector3d> ends_W;
};

std::vector<Fan> MakeFans(uint64_t seed, int count) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&] { return Eigen::Vector3d(uniform(engine), uniform(engine), uniform(engine)); };
  const GridShape shape = MakeShape();
  const Eigen::Vector3d half = 0.5 * shape.resolution_m * shape.size.cast<double>(), middle = shape.origin_W + half;
  std::vector<Fan> fans;
  for (int i = 0; i < count; ++i) {
    const double reach = i % 2 == 0 ? 0.9 : 2.5;
    Fan fan{middle + reach * half.cwiseProduct(draw()), {}};
    const Eigen::Vector3d first = middle + 2.0 * half.cwiseProduct(draw()), across = 0.3 * draw();
    const int beams = static_cast<int>(engine() % 70);
    for (int k = 0; k < beams; ++k) {
      Eigen::Vector3d end = first + (k / 60.0) * across;
      if (i % 7 == 3) end[i / 7 % 3] = fan.p_WA[i / 7 % 3];
      if (i % 11 == 5) end = (end / 0.005).array().round() * 0.005;
      fan.ends_W.push_back(end);
    }
    fans.push_back(fan);
  }
  return fans;
}

class RayBundleLanes : public testing::TestWithParam<LaneSet> {
 protected:
  void SetUp() override {
    if (!IsSupported(GetParam())) GTEST_SKIP() << "this processor has no " << ToString(GetParam());
  }
};

TEST_P(RayBundleLanes, ReadiesEachRayAsMakeRayWalkDoes) {
  const GridShape shape = MakeShape();
  RayBundle bundle(shape, GetParam());
  for (const Fan& fan : MakeFans(1, 3000)) {
    bundle.Set(fan.p_WA, fan.ends_W, LastCell::kIncluded);
    for (size_t i = 0; i < fan.ends_W.size(); ++i) {
      const RayWalk ray = MakeRayWalk(shape, fan.p_WA, fan.ends_W[i]);
      ASSERT_EQ(bundle.rays().steps[i], ray.steps);
      if (ray.steps < 0) continue;
      ASSERT_EQ(bundle.rays().index[i], ray.index);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(static_cast<uint32_t>(bundle.rays().t_max[axis][i]) ^ 0x80000000U, ray.t_max[axis]);
        ASSERT_EQ(static_cast<uint32_t>(bundle.rays().t_delta[axis][i]), ray.t_delta[axis]);
        ASSERT_EQ(bundle.rays().stride[axis][i], ray.stride[axis]);
      }
    }
  }
}

TEST_P(RayBundleLanes, ListsTheCellsOfAllRaysAndNoOther) {
  const GridShape shape = MakeShape();
  RayBundle bundle(shape, GetParam());
  for (const Fan& fan : MakeFans(2, 1000)) {
    for (const LastCell last_cell : {LastCell::kIncluded, LastCell::kLeftOut}) {
      bundle.Set(fan.p_WA, fan.ends_W, last_cell);
      const auto cells = bundle.ListCells();
      std::set<uint32_t> expected;
      for (const Eigen::Vector3d& p_WB : fan.ends_W) {
        RayWalk ray = MakeRayWalk(shape, fan.p_WA, p_WB);
        if (last_cell == LastCell::kLeftOut && FindCell(shape, p_WB) >= 0) --ray.steps;
        WalkRay(ray, [&](int64_t index) { return expected.insert(static_cast<uint32_t>(index)), true; });
      }
      ASSERT_EQ(std::set<uint32_t>(cells.begin(), cells.end()), expected);
    }
  }
}

TEST_P(RayBundleLanes, ListsMostSharedCellsOnce) {
  const GridShape shape = MakeShape();
  RayBundle bundle(shape, GetParam());
  Fan fan{{-0.05, 0.1, -0.19}, {}};
  for (int i = 0; i < 64; ++i) fan.ends_W.emplace_back(-0.01 + 0.0005 * i, 0.12, 0.08);
  bundle.Set(fan.p_WA, fan.ends_W, LastCell::kIncluded);
  const auto cells = bundle.ListCells();
  const std::set<uint32_t> once(cells.begin(), cells.end());
  int64_t visits = 0;
  for (int i = 0; i < 64; ++i) visits += bundle.rays().steps[i] + 1;
  EXPECT_GT(visits, 8 * static_cast<int64_t>(once.size()));
  // A group of lanes does not know its neighbours.
  EXPECT_LT(cells.size(), once.size() * (GetParam() == LaneSet::kSse42 ? 6 : 3));
}

TEST_P(RayBundleLanes, SumsUpToTheFirstWallOrGoal) {
  const GridShape shape = MakeShape();
  std::mt19937_64 engine(3);
  std::vector<uint16_t> values(shape.cells() + 1);
  for (uint16_t& value : values) {
    const uint64_t draw = engine() % 200;
    value = draw == 0 ? RayBundle::kWall : draw == 1 ? RayBundle::kGoal : static_cast<uint16_t>(engine() % 0xfffe);
  }
  RayBundle bundle(shape, GetParam());
  for (const Fan& fan : MakeFans(4, 1000)) {
    bundle.Set(fan.p_WA, fan.ends_W, LastCell::kIncluded);
    int64_t expected = 0;
    for (const Eigen::Vector3d& p_WB : fan.ends_W) {
      WalkRay(MakeRayWalk(shape, fan.p_WA, p_WB), [&](int64_t index) {
        const uint16_t value = values[index];
        if (value == RayBundle::kWall) return false;
        expected += value == RayBundle::kGoal ? 1 : value;
        return value != RayBundle::kGoal;
      });
    }
    ASSERT_EQ(bundle.Sum(values.data()), expected);
  }
}

TEST_P(RayBundleLanes, RaysOfBadEndsHaveNoCells) {
  const GridShape shape = MakeShape();
  RayBundle bundle(shape, GetParam());
  const Eigen::Vector3d in = shape.origin_W + Eigen::Vector3d::Constant(0.01);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300}) {
    bundle.Set(in, {Eigen::Vector3d(bad, 0.0, 0.0), Eigen::Vector3d(0.0, 0.06, bad), in}, LastCell::kIncluded);
    const auto cells = bundle.ListCells();
    ASSERT_EQ(cells.size(), 1U);
    EXPECT_EQ(cells[0], FindCell(shape, in));
    bundle.Set(Eigen::Vector3d(0.0, bad, 0.0), {in, in}, LastCell::kIncluded);
    EXPECT_TRUE(bundle.ListCells().empty());
  }
}

TEST_P(RayBundleLanes, OfNoRaysHasNoCells) {
  RayBundle bundle(MakeShape(), GetParam());
  bundle.Set(Eigen::Vector3d::Zero(), {}, LastCell::kIncluded);
  EXPECT_TRUE(bundle.ListCells().empty());
  const std::vector<uint16_t> values(MakeShape().cells() + 1, 7);
  EXPECT_EQ(bundle.Sum(values.data()), 0);
}

INSTANTIATE_TEST_SUITE_P(All, RayBundleLanes, testing::ValuesIn(kLaneSets), [](const auto& set) {
  return set.param == LaneSet::kSse42 ? "Sse42" : set.param == LaneSet::kAvx2 ? "Avx2" : "Avx512";
});

}  // namespace
}  // namespace nbs
