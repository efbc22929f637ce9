#include "services/planner/motion_planning/se3_search.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <initializer_list>
#include <memory>
#include <mutex>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Space = ob::SE3StateSpace;

/// Who draws; keys of the local seeds.
enum class Drawer : uint64_t { kSampler = 1, kSimplifier = 2 };

std::uint_fast32_t CalcLocalSeed(uint64_t seed, Drawer drawer) {
  return static_cast<std::uint_fast32_t>(CalcRandomBits({seed, static_cast<uint64_t>(drawer)}) & 0xffffffffu);
}

Pose ToPose(const ob::State* state) {
  const auto& s = *state->as<Space::StateType>();
  const auto& q = s.rotation();
  return MakePose({s.getX(), s.getY(), s.getZ()}, Eigen::Quaterniond(q.w, q.x, q.y, q.z));
}

void SetRotation(const Eigen::Quaterniond& rotation, Space::StateType& state) {
  auto& q = state.rotation();
  q.x = rotation.x();
  q.y = rotation.y();
  q.z = rotation.z();
  q.w = rotation.w();
}

void FromPose(const Pose& X_WB, ob::State* state) {
  auto& s = *state->as<Space::StateType>();
  s.setXYZ(X_WB.translation().x(), X_WB.translation().y(), X_WB.translation().z());
  SetRotation(Eigen::Quaterniond(X_WB.linear()), s);
}

/// Positions even in the box; orientations half of the time between those of start and goal, which gives calm motions,
/// otherwise even over all.
class Sampler final : public ob::StateSampler {
 public:
  Sampler(const ob::StateSpace* space, const Pose& X_WB_start, const Pose& X_WB_goal, uint64_t seed)
      : ob::StateSampler(space), q_start_(X_WB_start.linear()), q_goal_(X_WB_goal.linear()) {
    rng_.setLocalSeed(CalcLocalSeed(seed, Drawer::kSampler));
  }

  void sampleUniform(ob::State* state) override {
    auto& s = *state->as<Space::StateType>();
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    const auto draw = [&](int axis) { return rng_.uniformReal(bounds.low[axis], bounds.high[axis]); };
    const double x = draw(0);
    const double y = draw(1);
    const double z = draw(2);
    s.setXYZ(x, y, z);
    if (rng_.uniform01() < 0.5) {
      SetRotation(q_start_.slerp(rng_.uniform01(), q_goal_).normalized(), s);
    } else {
      double q[4];
      rng_.quaternion(q);
      SetRotation({q[3], q[0], q[1], q[2]}, s);
    }
  }

  // RRT-Connect and the simplifier draw from the whole space alone.
  void sampleUniformNear(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  Eigen::Quaterniond q_start_;
  Eigen::Quaterniond q_goal_;
};

/// The exact check in place of OMPL's sampled one.
class Validator final : public ob::MotionValidator {
 public:
  Validator(const ob::SpaceInformationPtr& info, const MotionCheck& is_free_motion)
      : ob::MotionValidator(info), is_free_motion_(is_free_motion) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const bool free = is_free_motion_(ToPose(from), ToPose(to));
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
  const MotionCheck& is_free_motion_;
};

class SeededSimplifier final : public og::PathSimplifier {
 public:
  SeededSimplifier(const ob::SpaceInformationPtr& info, uint64_t seed) : og::PathSimplifier(info) {
    rng_.setLocalSeed(CalcLocalSeed(seed, Drawer::kSimplifier));
  }
};

ob::SpaceInformationPtr MakeSpace(const Pose& X_WB_start, const Pose& X_WB_goal, const Se3SearchSettings& settings,
                                  const PoseCheck& is_free, const MotionCheck& is_free_motion) {
  Eigen::AlignedBox3d box_W = settings.box_W;
  box_W.extend(X_WB_start.translation()).extend(X_WB_goal.translation());
  ob::RealVectorBounds bounds(3);
  for (int axis = 0; axis < 3; ++axis) {
    bounds.setLow(axis, box_W.min()[axis]);
    bounds.setHigh(axis, box_W.max()[axis]);
  }
  const auto space = std::make_shared<Space>();
  space->setBounds(bounds);
  // OMPL's distance of two orientations is half of the angle between them.
  space->setSubspaceWeight(1, 2.0 * settings.metres_per_rad);
  space->setStateSamplerAllocator([=, seed = settings.seed](const ob::StateSpace* of) {
    return std::make_shared<Sampler>(of, X_WB_start, X_WB_goal, seed);
  });
  auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker([&](const ob::State* state) { return is_free(ToPose(state)); });
  info->setMotionValidator(std::make_shared<Validator>(info, is_free_motion));
  info->setup();
  return info;
}

/// The path's poses with the ends as they were asked for.
std::vector<Pose> ToPoses(const og::PathGeometric& path, const Pose& X_WB_start, const Pose& X_WB_goal) {
  std::vector<Pose> poses_WB;
  for (size_t k = 0; k < path.getStateCount(); ++k) poses_WB.push_back(ToPose(path.getState(k)));
  poses_WB.front() = X_WB_start;
  poses_WB.back() = X_WB_goal;
  return poses_WB;
}

bool IsFreePath(const std::vector<Pose>& poses_WB, const MotionCheck& is_free_motion) {
  for (size_t k = 0; k + 1 < poses_WB.size(); ++k) {
    if (!is_free_motion(poses_WB[k], poses_WB[k + 1])) return false;
  }
  return true;
}

void Silence() {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::noOutputHandler(); });
}

}  // namespace

std::vector<Pose> FindSe3Path(const Pose& X_WB_start, const Pose& X_WB_goal, const Se3SearchSettings& settings,
                              const PoseCheck& is_free, const MotionCheck& is_free_motion) {
  Silence();
  const ob::SpaceInformationPtr info = MakeSpace(X_WB_start, X_WB_goal, settings, is_free, is_free_motion);
  const auto problem = std::make_shared<ob::ProblemDefinition>(info);
  ob::ScopedState<> start(info);
  ob::ScopedState<> goal(info);
  FromPose(X_WB_start, start.get());
  FromPose(X_WB_goal, goal.get());
  problem->setStartAndGoalStates(start, goal);

  og::RRTConnect planner(info);
  planner.setRange(settings.range_m);
  planner.setProblemDefinition(problem);
  // A plain list: OMPL's default for nearest neighbours picks its pivots with random numbers of its own.
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  ob::IterationTerminationCondition end(settings.iterations);
  if (planner.solve(end) != ob::PlannerStatus::EXACT_SOLUTION) return {};

  const auto found = *problem->getSolutionPath()->as<og::PathGeometric>();
  og::PathGeometric shorter = found;
  SeededSimplifier simplifier(info, settings.seed);
  simplifier.reduceVertices(shorter, settings.shortcuts, settings.shortcuts, 1.0);
  simplifier.shortcutPath(shorter, settings.shortcuts, settings.shortcuts);
  simplifier.reduceVertices(shorter, settings.shortcuts, settings.shortcuts, 1.0);
  // Short cuts leave pieces of motions that were checked whole; the pieces are checked once more, so that the promise
  // holds to the letter.
  for (const og::PathGeometric* path : std::initializer_list<const og::PathGeometric*>{&shorter, &found}) {
    std::vector<Pose> poses_WB = ToPoses(*path, X_WB_start, X_WB_goal);
    if (IsFreePath(poses_WB, is_free_motion)) return poses_WB;
  }
  return {};
}

}  // namespace nbs
