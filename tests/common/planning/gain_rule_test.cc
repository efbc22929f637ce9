#include "common/planning/gain_rule.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nbs {
namespace {

TEST(GainRule, IsFoundByItsName) {
  for (int i = 0; i < kGainRules; ++i) {
    const auto rule = static_cast<GainRule>(i);
    EXPECT_EQ(FindGainRule(ToString(rule)), rule);
  }
  EXPECT_EQ(ToString(GainRule::kSum), "sum");
  EXPECT_EQ(ToString(GainRule::kUnknownCount), "unknown_count");
  EXPECT_EQ(FindGainRule("entropy"), std::nullopt);
  EXPECT_EQ(FindGainRule(""), std::nullopt);
}

TEST(GainRule, AllNamesAreListed) {
  ASSERT_EQ(GainRuleNames().size(), size_t{kGainRules});
  for (int i = 0; i < kGainRules; ++i) EXPECT_EQ(GainRuleNames()[i], ToString(static_cast<GainRule>(i)));
}

TEST(GainRule, OnlyMeanAndPerSecondWeighTheCost) {
  const PathCost cost = {.beams = 200, .seconds = 8.0};
  EXPECT_EQ(CalcScore(GainRule::kSum, 1000.0, cost), 1000.0);
  EXPECT_EQ(CalcScore(GainRule::kNearSurface, 1000.0, cost), 1000.0);
  EXPECT_EQ(CalcScore(GainRule::kUnknownCount, 1000.0, cost), 1000.0);
  EXPECT_EQ(CalcScore(GainRule::kMean, 1000.0, cost), 5.0);
  EXPECT_EQ(CalcScore(GainRule::kPerSecond, 1000.0, cost), 125.0);
}

TEST(GainRule, ACostOfNothingIsRefusedWhereItDivides) {
  const PathCost none = {.beams = 0, .seconds = 0.0};
  EXPECT_EQ(CalcScore(GainRule::kSum, 3.0, none), 3.0);
  EXPECT_THROW((void)CalcScore(GainRule::kMean, 3.0, none), std::invalid_argument);
  EXPECT_THROW((void)CalcScore(GainRule::kPerSecond, 3.0, none), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
