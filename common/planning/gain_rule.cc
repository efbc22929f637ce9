#include "common/planning/gain_rule.h"

#include <array>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

constexpr std::array<std::string_view, kGainRules> kNames = {"sum",        "near_surface",  "mean",
                                                             "per_second", "unknown_count", "surface"};

}  // namespace

std::string_view ToString(GainRule rule) { return kNames.at(static_cast<size_t>(rule)); }

std::optional<GainRule> FindGainRule(std::string_view name) {
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<GainRule>(i);
  }
  return std::nullopt;
}

std::span<const std::string_view> GainRuleNames() { return kNames; }

double CalcScore(GainRule rule, double gain_nat, const PathCost& cost) {
  if (rule != GainRule::kMean && rule != GainRule::kPerSecond) return gain_nat;
  const double divisor = rule == GainRule::kMean ? static_cast<double>(cost.beams) : cost.seconds;
  if (!(divisor > 0.0)) throw std::invalid_argument("CalcScore: a path of cost " + std::to_string(divisor));
  return gain_nat / divisor;
}

}  // namespace nbs
