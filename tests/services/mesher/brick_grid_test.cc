#include "services/mesher/brick_grid.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Key = std::tuple<int, int, int>;
constexpr float kCell_m = 0.002f;

Key KeyOf(const Eigen::Vector3f& p) {
  const auto cell = [](float c) { return static_cast<int>(std::floor(c / kCell_m)); };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

Eigen::Vector3f MakeRandomPoint(uint64_t n, double reach_m) {
  const auto draw = [&](uint64_t axis) {
    return static_cast<float>(reach_m * (2.0 * CalcUniform({21, n, axis}) - 1.0));
  };
  return {draw(0), draw(1), draw(2)};
}

/// A grid with 3000 random cells filled, and the same in a std::map.
struct Filled {
  BrickGrid grid{kCell_m};
  std::map<Key, int32_t> oracle;

  Filled() {
    for (int32_t n = 0; n < 3000; ++n) {
      const Eigen::Vector3f p = MakeRandomPoint(static_cast<uint64_t>(n), 0.03);
      grid.Touch(p) = n;
      oracle[KeyOf(p)] = n;
    }
  }
};

TEST(BrickGrid, FindsWhatWasPutIntoEachCell) {
  const Filled filled;
  for (uint64_t n = 0; n < 6000; ++n) {
    const Eigen::Vector3f p = MakeRandomPoint(n, 0.035);
    const auto it = filled.oracle.find(KeyOf(p));
    EXPECT_EQ(filled.grid.Find(p), it == filled.oracle.end() ? BrickGrid::kNone : it->second);
  }
}

TEST(BrickGrid, BoxSearchVisitsExactlyTheFilledCellsThatMeetTheBox) {
  const Filled filled;
  for (uint64_t n = 0; n < 200; ++n) {
    const Eigen::Vector3f p = MakeRandomPoint(n + 10000, 0.035);
    const float radius = 0.001f + 0.00005f * static_cast<float>(n);
    std::multiset<int32_t> visited, expected;
    filled.grid.ForEachCell(p, radius, [&](int32_t head) { visited.insert(head); });
    const auto [x0, y0, z0] = KeyOf(p - Eigen::Vector3f::Constant(radius));
    const auto [x1, y1, z1] = KeyOf(p + Eigen::Vector3f::Constant(radius));
    for (const auto& [key, head] : filled.oracle) {
      const auto [x, y, z] = key;
      if (x >= x0 && x <= x1 && y >= y0 && y <= y1 && z >= z0 && z <= z1) expected.insert(head);
    }
    EXPECT_EQ(visited, expected);
  }
}

TEST(BrickGrid, ClearedCellIsNotVisited) {
  BrickGrid grid(kCell_m);
  const Eigen::Vector3f p(-0.001f, 0.5f, 3.0f);
  grid.Touch(p) = 7;
  grid.Clear(p);
  EXPECT_EQ(grid.Find(p), BrickGrid::kNone);
  grid.ForEachCell(p, 0.01f, [](int32_t) { ADD_FAILURE(); });
}

TEST(BrickGrid, EmptiedAndFilledAgainHoldsTheNew) {
  Filled filled;
  for (const auto& [key, head] : filled.oracle) {
    const auto [x, y, z] = key;
    const Eigen::Vector3f p = kCell_m * (Eigen::Vector3i(x, y, z).cast<float>() + Eigen::Vector3f::Constant(0.5f));
    filled.grid.Clear(p);
    filled.grid.Clear(p);  // Once more is no harm.
    EXPECT_EQ(filled.grid.Find(p), BrickGrid::kNone);
    const Eigen::Vector3f elsewhere = p + Eigen::Vector3f(1.0f, 0.0f, 0.0f);
    filled.grid.Touch(elsewhere) = head;
    EXPECT_EQ(filled.grid.Find(elsewhere), head);
  }
  size_t visited = 0;
  filled.grid.ForEachCell(Eigen::Vector3f(1.0f, 0.0f, 0.0f), 0.04f, [&](int32_t) { ++visited; });
  EXPECT_EQ(visited, filled.oracle.size());
  filled.grid.ForEachCell(Eigen::Vector3f::Zero(), 0.04f, [&](int32_t) { ADD_FAILURE(); });
}

TEST(BrickGrid, CellWithoutSizeIsRefused) { EXPECT_THROW(BrickGrid(0.0f), std::invalid_argument); }

}  // namespace
}  // namespace nbs
