#include "services/planner/motion_planning/joint_search.h"

#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <memory>

#include "services/planner/motion_planning/state_search.h"

namespace nbs {
namespace {

namespace ob = ompl::base;
using Space = ob::RealVectorStateSpace;

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
    rng_.setLocalSeed(CalcSamplerSeed(seed));
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

ob::StateSpacePtr MakeSpace(const ArmModel& model, const Joints& q_start, const std::vector<Joints>& q_goals,
                            const JointSearchSettings& settings) {
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
  return space;
}

/// Number of the goal that is nearest to joint values.
size_t FindNearest(const std::vector<Joints>& q_goals, const Joints& q) {
  const auto nearest = std::min_element(q_goals.begin(), q_goals.end(), [&](const Joints& a, const Joints& b) {
    return (a - q).norm() < (b - q).norm();
  });
  return static_cast<size_t>(nearest - q_goals.begin());
}

}  // namespace

JointWay FindJointWay(const ArmModel& model, const Joints& q_start, const std::vector<Joints>& q_goals,
                      const JointSearchSettings& settings, const JointCheck& is_free,
                      const JointMotionCheck& is_free_motion) {
  const Scale scale(settings.metres_per_rad);
  StateSearch search;
  search.is_free = [&](const ob::State* state) { return is_free(scale.ToJoints(state)); };
  search.is_free_motion = [&](const ob::State* from, const ob::State* to) {
    return is_free_motion(scale.ToJoints(from), scale.ToJoints(to));
  };
  search.set_start = [&](ob::State* state) { scale.FromJoints(q_start, state); };
  for (const Joints& q_goal : q_goals)
    search.set_goals.emplace_back([&](ob::State* state) { scale.FromJoints(q_goal, state); });
  search.algorithm = settings.algorithm;
  search.range = settings.range_m;
  search.iterations = settings.iterations;
  search.shortcuts = settings.shortcuts;
  search.seed = settings.seed;
  JointWay found;
  FindStateWay(MakeSpace(model, q_start, q_goals, settings), search, [&](const std::vector<const ob::State*>& states) {
    JointWay way;
    for (const ob::State* state : states) way.q.push_back(scale.ToJoints(state));
    way.goal = FindNearest(q_goals, way.q.back());
    way.q.front() = q_start;
    way.q.back() = q_goals[way.goal];
    if (!IsFreeWay(way.q, is_free_motion)) return false;
    found = std::move(way);
    return true;
  });
  return found;
}

}  // namespace nbs
