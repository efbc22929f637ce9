#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "services/planner/motion_planning/motion_settings.h"

namespace ompl::base {
class State;
class StateSpace;
}  // namespace ompl::base

namespace nbs {

/// A way that is searched for in one of OMPL's state spaces; what the searches in SE(3) and in joint space share.
struct StateSearch {
  using State = ompl::base::State;

  std::function<bool(const State*)> is_free;
  std::function<bool(const State* from, const State* to)> is_free_motion;  ///< In place of OMPL's sampled check.
  std::function<void(State*)> set_start;
  std::vector<std::function<void(State*)>> set_goals;  ///< At least one; the search comes to any of them.
  SearchAlgorithm algorithm = SearchAlgorithm::kRrtConnect;
  double range = 0.3;  ///< Longest edge of the two trees, in OMPL's distance.
  int iterations = 0;  ///< Extensions of the two trees, or milestones of the roadmap, before it gives up.
  int shortcuts = 0;   ///< Attempts to shorten the way that was found.
  uint64_t seed = 0;
};

/// Takes a way from start to goal if its motions are free once its states have been converted and its ends are exactly
/// those that were asked for; false to be offered another one.
using TakeWay = std::function<bool(const std::vector<const ompl::base::State*>& way)>;

/// Finds a way, shortens it, and offers it; then the longer one as it was found. A pure function of its arguments: it
/// ends by count, and neither uses nor disturbs OMPL's process-wide random numbers if the sampler of the space does
/// not.
void FindStateWay(const std::shared_ptr<ompl::base::StateSpace>& space, const StateSearch& search, const TakeWay& take);

/// What the sampler of a space is seeded with; OMPL refuses 0.
std::uint_fast32_t CalcSamplerSeed(uint64_t seed);

/// True if every motion between two neighbours is free.
template <typename T, typename IsFreeMotion>
bool IsFreeWay(const std::vector<T>& way, const IsFreeMotion& is_free_motion) {
  for (size_t k = 0; k + 1 < way.size(); ++k) {
    if (!is_free_motion(way[k], way[k + 1])) return false;
  }
  return true;
}

}  // namespace nbs
