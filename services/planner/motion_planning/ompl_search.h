#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <functional>
#include <initializer_list>
#include <mutex>
#include <utility>
#include <vector>

#include "common/runtime/counter_random.h"
#include "services/planner/motion_planning/motion_settings.h"

/// What the searches in SE(3) and in joint space share; for their two source files alone.
namespace nbs::ompl_search {

/// Who draws random numbers; keys of the local seeds.
enum class Drawer : uint64_t { kSampler = 1, kSimplifier = 2 };

inline std::uint_fast32_t CalcLocalSeed(uint64_t seed, Drawer drawer) {
  const auto bits = static_cast<uint32_t>(CalcRandomBits({seed, static_cast<uint64_t>(drawer)}));
  return bits == 0 ? 1 : bits;  // OMPL refuses 0.
}

/// How states of OMPL and values of type T (poses, joint values) are searched for.
template <typename T>
struct Search {
  std::function<T(const ompl::base::State*)> to_value;
  std::function<bool(const T&)> is_free;
  std::function<bool(const T& from, const T& to)> is_free_motion;
  /// Replaces the first and the last value by those that were asked for.
  std::function<void(std::vector<T>&)> set_ends = {};
  SearchAlgorithm algorithm = SearchAlgorithm::kRrtConnect;
  double range = 0.3;  ///< Longest edge of the two trees, in OMPL's distance.
  int iterations = 0;  ///< Extensions of the two trees, or milestones of the roadmap, before it gives up.
  int shortcuts = 0;   ///< Attempts to shorten the path that was found.
  uint64_t seed = 0;
};

/// The exact check in place of OMPL's sampled one.
template <typename T>
class Validator final : public ompl::base::MotionValidator {
 public:
  Validator(const ompl::base::SpaceInformationPtr& info, const Search<T>& search)
      : ompl::base::MotionValidator(info), search_(search) {}

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override {
    const bool free = search_.is_free_motion(search_.to_value(from), search_.to_value(to));
    ++(free ? valid_ : invalid_);
    return free;
  }

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
    last_valid.second = 0.0;
    return false;
  }

 private:
  const Search<T>& search_;
};

class SeededSimplifier final : public ompl::geometric::PathSimplifier {
 public:
  SeededSimplifier(const ompl::base::SpaceInformationPtr& info, uint64_t seed) : ompl::geometric::PathSimplifier(info) {
    rng_.setLocalSeed(CalcLocalSeed(seed, Drawer::kSimplifier));
  }
};

/// A space with the checks of the search, which must outlive it.
template <typename T>
ompl::base::SpaceInformationPtr MakeInfo(const ompl::base::StateSpacePtr& space, const Search<T>& search) {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::noOutputHandler(); });
  auto info = std::make_shared<ompl::base::SpaceInformation>(space);
  info->setStateValidityChecker(
      [&search](const ompl::base::State* state) { return search.is_free(search.to_value(state)); });
  info->setMotionValidator(std::make_shared<Validator<T>>(info, search));
  info->setup();
  return info;
}

template <typename T>
std::vector<T> ToValues(const ompl::geometric::PathGeometric& path, const Search<T>& search) {
  std::vector<T> values;
  for (size_t k = 0; k < path.getStateCount(); ++k)
    values.push_back(search.to_value(path.getState(static_cast<unsigned>(k))));
  search.set_ends(values);
  return values;
}

template <typename T>
bool IsFreePath(const std::vector<T>& values, const Search<T>& search) {
  for (size_t k = 0; k + 1 < values.size(); ++k) {
    if (!search.is_free_motion(values[k], values[k + 1])) return false;
  }
  return true;
}

// Both searches get a plain list for nearest neighbours: OMPL's default picks its pivots with random numbers of its
// own.

/// OMPL's PRM looks for a way in a thread of its own and grows until that thread says so; here the roadmap is asked
/// after every tenth milestone, which makes it repeatable.
class CountedPrm final : public ompl::geometric::PRM {
 public:
  using ompl::geometric::PRM::PRM;

  /// A way to any of the goals, or null after so many milestones.
  ompl::base::PathPtr Find(int milestones) {
    constexpr unsigned kAtATime = 10;
    setNearestNeighbors<ompl::NearestNeighborsLinear>();
    nn_->setDistanceFunction([this](Vertex a, Vertex b) { return distanceFunction(a, b); });
    checkValidity();
    while (const ompl::base::State* start = pis_.nextStart()) startM_.push_back(addMilestone(si_->cloneState(start)));
    while (const ompl::base::State* goal = pis_.nextGoal()) goalM_.push_back(addMilestone(si_->cloneState(goal)));
    ompl::base::PathPtr way;
    for (int grown = 0; !maybeConstructSolution(startM_, goalM_, way); grown += static_cast<int>(kAtATime)) {
      if (grown >= milestones) return nullptr;
      ompl::base::IterationTerminationCondition end(kAtATime);
      growRoadmap(end);
    }
    return way;
  }
};

inline ompl::base::PathPtr FindByPrm(const ompl::base::SpaceInformationPtr& info,
                                     const ompl::base::ProblemDefinitionPtr& problem, int milestones) {
  CountedPrm planner(info);
  planner.setProblemDefinition(problem);
  return planner.Find(milestones);
}

inline ompl::base::PathPtr FindByRrtConnect(const ompl::base::SpaceInformationPtr& info,
                                            const ompl::base::ProblemDefinitionPtr& problem, double range,
                                            int iterations) {
  ompl::geometric::RRTConnect planner(info);
  planner.setRange(range);
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  planner.setProblemDefinition(problem);
  ompl::base::IterationTerminationCondition end(static_cast<unsigned>(iterations));
  if (planner.solve(end) != ompl::base::PlannerStatus::EXACT_SOLUTION) return nullptr;
  return problem->getSolutionPath();
}

/// Solves a problem and shortens what was found. Every motion between two neighbours is free; empty if nothing was
/// found.
template <typename T>
std::vector<T> Solve(const ompl::base::SpaceInformationPtr& info, const ompl::base::ProblemDefinitionPtr& problem,
                     const Search<T>& search) {
  const ompl::base::PathPtr way = search.algorithm == SearchAlgorithm::kPrm
                                      ? FindByPrm(info, problem, search.iterations)
                                      : FindByRrtConnect(info, problem, search.range, search.iterations);
  if (way == nullptr) return {};

  const auto found = *way->as<ompl::geometric::PathGeometric>();
  ompl::geometric::PathGeometric shorter = found;
  SeededSimplifier simplifier(info, search.seed);
  const auto attempts = static_cast<unsigned>(search.shortcuts);
  simplifier.reduceVertices(shorter, attempts, attempts, 1.0);
  simplifier.shortcutPath(shorter, attempts, attempts);
  simplifier.reduceVertices(shorter, attempts, attempts, 1.0);
  // Short cuts leave pieces of motions that were checked whole; the pieces are checked once more, so that the promise
  // holds to the letter.
  for (const ompl::geometric::PathGeometric* path :
       std::initializer_list<const ompl::geometric::PathGeometric*>{&shorter, &found}) {
    std::vector<T> values = ToValues(*path, search);
    if (IsFreePath(values, search)) return values;
  }
  return {};
}

}  // namespace nbs::ompl_search
