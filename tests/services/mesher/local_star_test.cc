#include "services/mesher/local_star.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

std::vector<StarCandidate> MakeRandomCandidates(uint64_t seed, int count, bool half_plane) {
  std::vector<StarCandidate> candidates;
  for (int i = 0; i < count; ++i) {
    const uint64_t n = static_cast<uint64_t>(i);
    const float x = static_cast<float>(2.0 * CalcUniform({seed, n, 0}) - 1.0);
    const float y = static_cast<float>(2.0 * CalcUniform({seed, n, 1}) - (half_plane ? 0.0 : 1.0));
    candidates.push_back({static_cast<uint32_t>(i), Eigen::Vector3f(x, y, 0.0f) * 0.005f});
  }
  return candidates;
}

std::vector<uint32_t> Neighbours(const LocalStar& star) {
  return {star.neighbours.begin(), star.neighbours.begin() + star.degree};
}

/// Pairs (a, b), counter-clockwise, whose circle through the origin holds no other candidate.
std::set<std::pair<uint32_t, uint32_t>> FindDelaunayPairs(const std::vector<StarCandidate>& candidates) {
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (const auto& a : candidates) {
    for (const auto& b : candidates) {
      const Eigen::Vector2d p = a.p_W.head<2>().cast<double>(), q = b.p_W.head<2>().cast<double>();
      const double area = p.x() * q.y() - p.y() * q.x();
      if (area <= 0.0) continue;
      const Eigen::Vector2d centre = Eigen::Vector2d(q.y() * p.squaredNorm() - p.y() * q.squaredNorm(),
                                                     p.x() * q.squaredNorm() - q.x() * p.squaredNorm()) /
                                     (2.0 * area);
      const bool empty = std::none_of(candidates.begin(), candidates.end(), [&](const StarCandidate& c) {
        return c.id != a.id && c.id != b.id && (c.p_W.head<2>().cast<double>() - centre).norm() < centre.norm();
      });
      if (empty) pairs.insert({a.id, b.id});
    }
  }
  return pairs;
}

std::set<std::pair<uint32_t, uint32_t>> PairsOf(const LocalStar& star) {
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (uint32_t id : Neighbours(star)) {
    if (star.FindNext(id) != LocalStar::kNone) pairs.insert({id, star.FindNext(id)});
  }
  return pairs;
}

class RandomStar : public testing::TestWithParam<int> {};

TEST_P(RandomStar, HasTheTrianglesWhoseCirclesAreEmpty) {
  StarScratch scratch;
  const uint64_t seed = static_cast<uint64_t>(GetParam());
  const auto candidates = MakeRandomCandidates(seed, 4 + GetParam() % 17, GetParam() % 3 == 0);
  const LocalStar star = CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch);
  EXPECT_EQ(PairsOf(star), FindDelaunayPairs(candidates));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomStar, testing::Range(1, 200));

TEST(LocalStar, NoCandidatesGiveAnEmptyStar) {
  StarScratch scratch;
  EXPECT_EQ(CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), {}, scratch).degree, 0);
}

TEST(LocalStar, HalfPlaneLeavesTheStarOpen) {
  StarScratch scratch;
  const std::vector<StarCandidate> candidates{{7, {1, 0, 0}}, {8, {0, 1, 0}}, {9, {-1, 0, 0}}};
  const LocalStar star = CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch);
  EXPECT_FALSE(star.closed);
  EXPECT_EQ(Neighbours(star), (std::vector<uint32_t>{7, 8, 9}));
  EXPECT_EQ(star.FindNext(9), LocalStar::kNone);
}

TEST(LocalStar, FlippedNormalReversesTheOrder) {
  StarScratch scratch;
  const auto candidates = MakeRandomCandidates(11, 12, false);
  const auto up = PairsOf(CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch));
  std::set<std::pair<uint32_t, uint32_t>> reversed;
  for (const auto& [a, b] :
       PairsOf(CalcLocalStar(Eigen::Vector3f::Zero(), -Eigen::Vector3f::UnitZ(), candidates, scratch)))
    reversed.insert({b, a});
  EXPECT_EQ(up, reversed);
}

TEST(LocalStar, OrderOfTheCandidatesDoesNotMatter) {
  StarScratch scratch;
  auto candidates = MakeRandomCandidates(5, 15, false);
  const LocalStar star = CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch);
  std::reverse(candidates.begin(), candidates.end());
  EXPECT_EQ(star, CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch));
}

TEST(LocalStar, SlopingCandidateLiesAtItsTrueDistance) {
  StarScratch scratch;
  // (2, 0, 2) squeezed flat would lie at distance 2 and hide (2.3, 0.1, 0)'s side of the star less than it does
  // at 2.83.
  const std::vector<StarCandidate> candidates{{1, {2, 0, 2}}, {2, {2.3f, 0.1f, 0}}, {3, {-1, 2, 0}}, {4, {-1, -2, 0}}};
  const auto ids = Neighbours(CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch));
  EXPECT_TRUE(std::find(ids.begin(), ids.end(), 2u) != ids.end());
}

TEST(LocalStar, OnlyTheNearestOfTooManyCandidatesCount) {
  StarScratch scratch;
  std::vector<StarCandidate> candidates;
  for (uint32_t i = 0; i < 60; ++i) {
    const float a = 0.1f + 2.0f * static_cast<float>(M_PI) * static_cast<float>(i) / 60.0f;
    candidates.push_back(
        {i, Eigen::Vector3f(std::cos(a), std::sin(a), 0.0f) * (1.0f + 0.001f * static_cast<float>(i))});
  }
  const LocalStar star = CalcLocalStar(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), candidates, scratch);
  for (uint32_t id : Neighbours(star)) EXPECT_LT(id, static_cast<uint32_t>(LocalStar::kMaxDegree));
}

}  // namespace
}  // namespace nbs
