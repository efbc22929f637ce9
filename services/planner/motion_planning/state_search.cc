#include "services/planner/motion_planning/state_search.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <mutex>
#include <utility>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// Who draws random numbers; keys of the local seeds.
enum class Drawer : uint64_t { kSampler = 1, kSimplifier = 2 };

std::uint_fast32_t CalcLocalSeed(uint64_t seed, Drawer drawer) {
  const auto bits = static_cast<uint32_t>(CalcRandomBits({seed, static_cast<uint64_t>(drawer)}));
  return bits == 0 ? 1 : bits;
}

class Validator final : public ob::MotionValidator {
 public:
  Validator(const ob::SpaceInformationPtr& info, const StateSearch& search)
      : ob::MotionValidator(info), search_(search) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const bool free = search_.is_free_motion(from, to);
    ++(free ? valid_ : invalid_);
    return free;
  }

  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
    last_valid.second = 0.0;
    return false;
  }

 private:
  const StateSearch& search_;
};

class SeededSimplifier final : public og::PathSimplifier {
 public:
  SeededSimplifier(const ob::SpaceInformationPtr& info, uint64_t seed) : og::PathSimplifier(info) {
    rng_.setLocalSeed(CalcLocalSeed(seed, Drawer::kSimplifier));
  }
};

// Both searches get a plain list for nearest neighbours: OMPL's default picks its pivots with random numbers of its
// own.

/// OMPL's PRM looks for a way in a thread of its own and grows until that thread says so; here the roadmap is asked
/// after every tenth milestone, which makes it repeatable.
class CountedPrm final : public og::PRM {
 public:
  using og::PRM::PRM;

  /// A way to any of the goals, or null after so many milestones.
  ob::PathPtr Find(int milestones) {
    constexpr unsigned kAtATime = 10;
    setNearestNeighbors<ompl::NearestNeighborsLinear>();
    nn_->setDistanceFunction([this](Vertex a, Vertex b) { return distanceFunction(a, b); });
    checkValidity();
    while (const ob::State* start = pis_.nextStart()) startM_.push_back(addMilestone(si_->cloneState(start)));
    while (const ob::State* goal = pis_.nextGoal()) goalM_.push_back(addMilestone(si_->cloneState(goal)));
    ob::PathPtr way;
    for (int grown = 0; !maybeConstructSolution(startM_, goalM_, way); grown += static_cast<int>(kAtATime)) {
      if (grown >= milestones) return nullptr;
      ob::IterationTerminationCondition end(kAtATime);
      growRoadmap(end);
    }
    return way;
  }
};

ob::PathPtr FindByPrm(const ob::SpaceInformationPtr& info, const ob::ProblemDefinitionPtr& problem, int milestones) {
  CountedPrm planner(info);
  planner.setProblemDefinition(problem);
  return planner.Find(milestones);
}

ob::PathPtr FindByRrtConnect(const ob::SpaceInformationPtr& info, const ob::ProblemDefinitionPtr& problem, double range,
                             int iterations) {
  og::RRTConnect planner(info);
  planner.setRange(range);
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  planner.setProblemDefinition(problem);
  ob::IterationTerminationCondition end(static_cast<unsigned>(iterations));
  if (planner.solve(end) != ob::PlannerStatus::EXACT_SOLUTION) return nullptr;
  return problem->getSolutionPath();
}

/// The space with the checks of the search, which must outlive it.
ob::SpaceInformationPtr MakeInfo(const ob::StateSpacePtr& space, const StateSearch& search) {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::noOutputHandler(); });
  auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker(search.is_free);
  info->setMotionValidator(std::make_shared<Validator>(info, search));
  info->setup();
  return info;
}

ob::ProblemDefinitionPtr MakeProblem(const ob::SpaceInformationPtr& info, const StateSearch& search) {
  auto problem = std::make_shared<ob::ProblemDefinition>(info);
  ob::ScopedState<> state(info);
  search.set_start(state.get());
  problem->addStartState(state);
  const auto goals = std::make_shared<ob::GoalStates>(info);
  for (const auto& set_goal : search.set_goals) {
    set_goal(state.get());
    goals->addState(state);
  }
  problem->setGoal(goals);
  return problem;
}

void Shorten(const ob::SpaceInformationPtr& info, const StateSearch& search, og::PathGeometric& path) {
  SeededSimplifier simplifier(info, search.seed);
  const auto attempts = static_cast<unsigned>(search.shortcuts);
  simplifier.reduceVertices(path, attempts, attempts, 1.0);
  simplifier.shortcutPath(path, attempts, attempts);
  simplifier.reduceVertices(path, attempts, attempts, 1.0);
}

bool Offer(const og::PathGeometric& path, const TakeWay& take) {
  std::vector<const ob::State*> way;
  for (size_t k = 0; k < path.getStateCount(); ++k) way.push_back(path.getState(static_cast<unsigned>(k)));
  return take(way);
}

}  // namespace

std::uint_fast32_t CalcSamplerSeed(uint64_t seed) { return CalcLocalSeed(seed, Drawer::kSampler); }

void FindStateWay(const ob::StateSpacePtr& space, const StateSearch& search, const TakeWay& take) {
  const ob::SpaceInformationPtr info = MakeInfo(space, search);
  const ob::ProblemDefinitionPtr problem = MakeProblem(info, search);
  const ob::PathPtr found = search.algorithm == SearchAlgorithm::kPrm
                                ? FindByPrm(info, problem, search.iterations)
                                : FindByRrtConnect(info, problem, search.range, search.iterations);
  if (found == nullptr) return;
  og::PathGeometric shorter = *found->as<og::PathGeometric>();
  Shorten(info, search, shorter);
  // Short cuts leave pieces of motions that were checked whole. The pieces are checked once more by whoever takes them,
  // so that the promise holds to the letter.
  if (!Offer(shorter, take)) Offer(*found->as<og::PathGeometric>(), take);
}

}  // namespace nbs
