#include "services/mesher/star_store.h"

#include <gtest/gtest.h>

#include <map>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

LocalStar MakeRandomStar(uint64_t seed) {
  LocalStar star;
  star.degree = static_cast<uint8_t>(CalcRandomBits({71, seed}) % (LocalStar::kMaxDegree + 1));
  star.closed = star.degree > 2 && seed % 2 == 0;
  for (uint32_t i = 0; i < star.degree; ++i) star.neighbours[i] = 100 * i + static_cast<uint32_t>(seed % 100);
  return star;
}

TEST(StarStore, GivesBackTheLastStarOfEachVertex) {
  StarStore store;
  std::map<uint32_t, LocalStar> oracle;
  for (uint64_t n = 0; n < 5000; ++n) {
    const auto id = static_cast<uint32_t>(CalcRandomBits({72, n}) % 300);
    oracle[id] = MakeRandomStar(n);
    store.Set(id, oracle[id]);
  }
  for (const auto& [id, star] : oracle) {
    EXPECT_EQ(store.Get(id), star);
    EXPECT_EQ(store.IsClosed(id), star.closed);
    for (uint32_t i = 0; i < star.degree; ++i)
      EXPECT_EQ(store.FindNext(id, star.neighbours[i]), star.FindNext(star.neighbours[i]));
    EXPECT_EQ(store.FindNext(id, 99'999), LocalStar::kNone);
  }
}

TEST(StarStore, VertexWithoutStarHasNone) {
  StarStore store;
  store.Set(9, MakeRandomStar(4));
  EXPECT_EQ(store.Get(3).degree, 0);
  EXPECT_EQ(store.Get(30).degree, 0);
  EXPECT_FALSE(store.IsClosed(30));
  EXPECT_EQ(store.FindNext(3, 1), LocalStar::kNone);
}

}  // namespace
}  // namespace nbs
