#include "services/planner/motion_planning/joint_search.h"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <mutex>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Space = ob::RealVectorStateSpace;

constexpr uint64_t kSamplerKey = 1;
constexpr uint64_t kSimplifierKey = 2;

std::uint_fast32_t CalcLocalSeed(uint64_t seed, uint64_t key) {
  // OMPL's generators refuse 0.
  return static_cast<std::uint_fast32_t>(CalcRandomBits({seed, key}) % 0x7fffffff) + 1;
}

/// States are joint values times their weights, so that OMPL's distances are those of the settings.
class Scale {
 public:
  explicit Scale(const std::vector<double>& weights) : weights_(weights) {}
  Joints ToJoints(const ob::State* state) const {
    const auto& s = *state->as<Space::StateType>();
    Joints q(static_cast<Eigen::Index>(weights_.size()));
    for (size_t k = 0; k < weights_.size(); ++k)
      q[static_cast<Eigen::Index>(k)] = s[static_cast<unsigned>(k)] / weights_[k];
    return q;
  }
  void FromJoints(const Joints& q, ob::State* state) const {
    auto& s = *state->as<Space::StateType>();
    for (size_t k = 0; k < weights_.size(); ++k)
      s[static_cast<unsigned>(k)] = q[static_cast<Eigen::Index>(k)] * weights_[k];
  }

 private:
  const std::vector<double>& weights_;
};

/// Most samples near the box about start and goals, which gives calm motions, the others even within the limits.
class Sampler final : public ob::StateSampler {
 public:
  Sampler(const ob::StateSpace* space, std::vector<double> low, std::vector<double> high, uint64_t seed)
      : ob::StateSampler(space), low_(std::move(low)), high_(std::move(high)) {
    rng_.setLocalSeed(CalcLocalSeed(seed, kSamplerKey));
  }

  void sampleUniform(ob::State* state) override {
    constexpr double kShareNear = 0.75;
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    const bool near = rng_.uniform01() < kShareNear;
    auto& s = *state->as<Space::StateType>();
    for (unsigned k = 0; k < low_.size(); ++k)
      s[k] = near ? rng_.uniformReal(low_[k], high_[k]) : rng_.uniformReal(bounds.low[k], bounds.high[k]);
  }

  // RRT-Connect and the simplifier draw from the whole space alone.
  void sampleUniformNear(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  std::vector<double> low_;
  std::vector<double> high_;
};

/// The exact check in place of OMPL's sampled one.
class Validator final : public ob::MotionValidator {
 public:
  Validator(const ob::SpaceInformationPtr& info, Scale scale, const JointMotionCheck& is_free_motion)
      : ob::MotionValidator(info), scale_(scale), is_free_motion_(is_free_motion) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const bool free = is_free_motion_(scale_.ToJoints(from), scale_.ToJoints(to));
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
  Scale scale_;
  const JointMotionCheck& is_free_motion_;
};

class SeededSimplifier final : public og::PathSimplifier {
 public:
  SeededSimplifier(const ob::SpaceInformationPtr& info, uint64_t seed) : og::PathSimplifier(info) {
    rng_.setLocalSeed(CalcLocalSeed(seed, kSimplifierKey));
  }
};

/// One search with everything that it needs.
class Search {
 public:
  Search(const ArmModel& model, const Joints& q_start, const std::vector<Joints>& q_goals,
         const JointSearchSettings& settings, const JointCheck& is_free, const JointMotionCheck& is_free_motion)
      : q_start_(q_start),
        q_goals_(q_goals),
        settings_(settings),
        scale_(settings.metres_per_rad),
        is_free_motion_(is_free_motion) {
    const auto n = static_cast<unsigned>(model.n());
    const auto space = std::make_shared<Space>(n);
    ob::RealVectorBounds bounds(n);
    std::vector<double> low(n);
    std::vector<double> high(n);
    for (unsigned k = 0; k < n; ++k) {
      const double weight = settings.metres_per_rad[k];
      const ArmJoint& joint = model.joints[k];
      bounds.setLow(k, weight * joint.min_rad);
      bounds.setHigh(k, weight * joint.max_rad);
      low[k] = high[k] = q_start[k];
      for (const Joints& q : q_goals) {
        low[k] = std::min(low[k], q[k]);
        high[k] = std::max(high[k], q[k]);
      }
      low[k] = weight * std::max(joint.min_rad, low[k] - settings.around_rad);
      high[k] = weight * std::min(joint.max_rad, high[k] + settings.around_rad);
    }
    space->setBounds(bounds);
    space->setStateSamplerAllocator(
        [=, seed = settings.seed](const ob::StateSpace* of) { return std::make_shared<Sampler>(of, low, high, seed); });
    info_ = std::make_shared<ob::SpaceInformation>(space);
    info_->setStateValidityChecker(
        [this, &is_free](const ob::State* state) { return is_free(scale_.ToJoints(state)); });
    info_->setMotionValidator(std::make_shared<Validator>(info_, scale_, is_free_motion));
    info_->setup();
  }

  JointWay Run() const {
    const auto problem = std::make_shared<ob::ProblemDefinition>(info_);
    ob::ScopedState<> state(info_);
    scale_.FromJoints(q_start_, state.get());
    problem->addStartState(state);
    const auto goals = std::make_shared<ob::GoalStates>(info_);
    for (const Joints& q : q_goals_) {
      scale_.FromJoints(q, state.get());
      goals->addState(state);
    }
    problem->setGoal(goals);
    og::RRTConnect planner(info_);
    planner.setRange(settings_.range_m);
    planner.setProblemDefinition(problem);
    // A plain list: OMPL's default for nearest neighbours picks its pivots with random numbers of its own.
    planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
    ob::IterationTerminationCondition end(static_cast<unsigned>(settings_.iterations));
    if (planner.solve(end) != ob::PlannerStatus::EXACT_SOLUTION) return {};
    return Shorten(*problem->getSolutionPath()->as<og::PathGeometric>());
  }

 private:
  JointWay Shorten(const og::PathGeometric& found) const {
    og::PathGeometric shorter = found;
    SeededSimplifier simplifier(info_, settings_.seed);
    const auto attempts = static_cast<unsigned>(settings_.shortcuts);
    simplifier.reduceVertices(shorter, attempts, attempts, 1.0);
    simplifier.shortcutPath(shorter, attempts, attempts);
    simplifier.reduceVertices(shorter, attempts, attempts, 1.0);
    // Short cuts leave pieces of motions that were checked whole; the pieces are checked once more.
    for (const og::PathGeometric* path : std::initializer_list<const og::PathGeometric*>{&shorter, &found}) {
      JointWay way = ToWay(*path);
      if (IsFree(way.q)) return way;
    }
    return {};
  }

  /// The path's states with the ends as they were asked for.
  JointWay ToWay(const og::PathGeometric& path) const {
    JointWay way;
    for (size_t k = 0; k < path.getStateCount(); ++k)
      way.q.push_back(scale_.ToJoints(path.getState(static_cast<unsigned>(k))));
    const auto distance = [&](const Joints& q) { return (q - way.q.back()).norm(); };
    const auto nearest = std::min_element(q_goals_.begin(), q_goals_.end(),
                                          [&](const Joints& a, const Joints& b) { return distance(a) < distance(b); });
    way.goal = static_cast<size_t>(nearest - q_goals_.begin());
    way.q.front() = q_start_;
    way.q.back() = *nearest;
    return way;
  }

  bool IsFree(const std::vector<Joints>& q) const {
    for (size_t k = 0; k + 1 < q.size(); ++k) {
      if (!is_free_motion_(q[k], q[k + 1])) return false;
    }
    return true;
  }

  const Joints& q_start_;
  const std::vector<Joints>& q_goals_;
  const JointSearchSettings& settings_;
  Scale scale_;
  const JointMotionCheck& is_free_motion_;
  ob::SpaceInformationPtr info_;
};

void Silence() {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::noOutputHandler(); });
}

}  // namespace

JointWay FindJointWay(const ArmModel& model, const Joints& q_start, const std::vector<Joints>& q_goals,
                      const JointSearchSettings& settings, const JointCheck& is_free,
                      const JointMotionCheck& is_free_motion) {
  Silence();
  return Search(model, q_start, q_goals, settings, is_free, is_free_motion).Run();
}

}  // namespace nbs
