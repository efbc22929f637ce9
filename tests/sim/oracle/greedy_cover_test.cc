#include "sim/oracle/greedy_cover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

CoverTable MakeTable(const std::vector<std::vector<size_t>>& rows, size_t samples) {
  CoverTable table(rows.size(), samples);
  for (size_t path = 0; path < rows.size(); ++path) {
    for (size_t sample : rows[path]) table.Mark(path, sample);
  }
  return table;
}

/// Each path covers about a share of the samples, with lengths in [0.1, 0.6).
struct RandomCase {
  RandomCase(uint64_t seed, size_t paths, size_t samples) {
    for (size_t path = 0; path < paths; ++path) {
      const double share = 0.3 * CalcUniform({seed, path, 1});
      rows.emplace_back();
      for (size_t sample = 0; sample < samples; ++sample) {
        if (CalcUniform({seed, path, 2, sample}) < share) rows.back().push_back(sample);
      }
      lengths_m.push_back(0.1 + 0.5 * CalcUniform({seed, path, 3}));
    }
  }
  std::vector<std::vector<size_t>> rows;
  std::vector<double> lengths_m;
};

/// By counting everything anew in every round.
std::vector<size_t> FindByBruteForce(const RandomCase& random, const CoverSettings& settings) {
  std::set<size_t> covered;
  std::vector<size_t> order;
  while (true) {
    double best_score = 0.0;
    size_t best = 0;
    for (size_t path = 0; path < random.rows.size(); ++path) {
      const auto gain = std::count_if(random.rows[path].begin(), random.rows[path].end(),
                                      [&](size_t sample) { return !covered.contains(sample); });
      const double cost = settings.rule == CoverRule::kMetre ? random.lengths_m[path] + settings.metre_offset_m : 1.0;
      if (static_cast<double>(gain) / cost > best_score) {
        best_score = static_cast<double>(gain) / cost;
        best = path;
      }
    }
    if (best_score == 0.0) return order;
    order.push_back(best);
    covered.insert(random.rows[best].begin(), random.rows[best].end());
  }
}

std::vector<size_t> ListPaths(const std::vector<CoverStep>& steps) {
  std::vector<size_t> paths;
  for (const CoverStep& step : steps) paths.push_back(step.path);
  return paths;
}

TEST(GreedyCover, TakesTheMostNewSamplesFirst) {
  const CoverTable table = MakeTable({{0, 1}, {0, 1, 2, 3}, {3, 4, 5}, {5, 70}}, 71);
  const auto steps = FindGreedyCover(table, std::vector<double>(4, 1.0), {});
  EXPECT_THAT(ListPaths(steps), ::testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(steps[0].covered, 4u);
  EXPECT_EQ(steps[1].covered, 6u);
  EXPECT_EQ(steps[2].covered, 7u);
  EXPECT_EQ(table.CountCovered(), 7u);
}

TEST(GreedyCover, ByTheMetrePrefersTheShortPath) {
  const CoverTable table = MakeTable({{0, 1, 2, 3}, {0, 1, 2}}, 4);
  CoverSettings settings;
  settings.rule = CoverRule::kMetre;
  EXPECT_EQ(FindGreedyCover(table, std::vector<double>{0.6, 0.1}, settings)[0].path, 1u);
  settings.metre_offset_m = 10.0;
  EXPECT_EQ(FindGreedyCover(table, std::vector<double>{0.6, 0.1}, settings)[0].path, 0u);
}

TEST(GreedyCover, BetweenEqualPathsTheLowerNumberWins) {
  const CoverTable table = MakeTable({{3}, {0, 1}, {1, 2}, {0, 2}}, 4);
  EXPECT_THAT(ListPaths(FindGreedyCover(table, std::vector<double>(4, 1.0), {})), ::testing::ElementsAre(1, 0, 2));
}

TEST(GreedyCover, BeginsWithTheGivenPathEvenIfItCoversNothing) {
  const CoverTable table = MakeTable({{0, 1}, {}}, 2);
  CoverSettings settings;
  settings.first = 1;
  EXPECT_THAT(ListPaths(FindGreedyCover(table, std::vector<double>(2, 1.0), settings)), ::testing::ElementsAre(1, 0));
}

TEST(GreedyCover, StopsAtTheMostPathsAllowed) {
  const CoverTable table = MakeTable({{0}, {1}, {2}}, 3);
  CoverSettings settings;
  settings.max_paths = 2;
  EXPECT_EQ(FindGreedyCover(table, std::vector<double>(3, 1.0), settings).size(), 2u);
}

TEST(GreedyCover, IsThatOfBruteForce) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomCase random(seed, 40, 200);
    for (const CoverRule rule : {CoverRule::kScan, CoverRule::kMetre}) {
      CoverSettings settings;
      settings.rule = rule;
      const auto steps = FindGreedyCover(MakeTable(random.rows, 200), random.lengths_m, settings);
      EXPECT_EQ(ListPaths(steps), FindByBruteForce(random, settings)) << seed;
    }
  }
}

TEST(GreedyCover, ComesWithinTheKnownBoundOfTheBest) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomCase random(seed, 15, 60);
    const auto steps = FindGreedyCover(MakeTable(random.rows, 60), random.lengths_m, {});
    size_t best = 0;
    for (size_t a = 0; a < 15; ++a) {
      for (size_t b = a + 1; b < 15; ++b) {
        for (size_t c = b + 1; c < 15; ++c) {
          std::set<size_t> covered;
          for (size_t path : {a, b, c}) covered.insert(random.rows[path].begin(), random.rows[path].end());
          best = std::max(best, covered.size());
        }
      }
    }
    ASSERT_GE(steps.size(), 3u);
    EXPECT_GE(static_cast<double>(steps[2].covered), (1.0 - 8.0 / 27.0) * static_cast<double>(best)) << seed;
    EXPECT_LE(steps[2].covered, best);
  }
}

TEST(GreedyCover, RefusesWhatDoesNotFit) {
  const CoverTable table(2, 10);
  CoverSettings settings;
  EXPECT_THAT([&] { FindGreedyCover(table, std::vector<double>(3, 1.0), settings); },
              ::testing::Throws<std::invalid_argument>());
  settings.first = 2;
  EXPECT_THAT([&] { FindGreedyCover(table, std::vector<double>(2, 1.0), settings); },
              ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
