#include "common/planning/method.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

constexpr std::array<Method, 5> kMethods = {{
    {.name = "BH/IG"},
    {.name = "B/IG", .search = CandidateSearch::kBoundary},
    {.name = "B",
     .search = CandidateSearch::kBoundary,
     .by_gain = false,
     .end = EndRule::kNothingLeft,
     .collision_test = false},
    {.name = "S/IG", .search = CandidateSearch::kSphere},
    {.name = "S",
     .search = CandidateSearch::kSphere,
     .gain = GainRule::kUnknownCount,
     .end = EndRule::kUnknownSettled,
     .collision_test = false},
}};

}  // namespace

std::span<const std::string_view> MethodNames() {
  static constexpr auto kNames = [] {
    std::array<std::string_view, kMethods.size()> names;
    for (size_t i = 0; i < names.size(); ++i) names[i] = kMethods[i].name;
    return names;
  }();
  return kNames;
}

const Method& FindMethod(std::string_view name) {
  const auto found = std::ranges::find(kMethods, name, &Method::name);
  if (found == kMethods.end()) throw std::invalid_argument("there is no method `" + std::string(name) + "`");
  return *found;
}

}  // namespace nbs
