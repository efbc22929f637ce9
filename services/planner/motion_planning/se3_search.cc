#include "services/planner/motion_planning/se3_search.h"

#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/SE3StateSpace.h>

#include <memory>

#include "services/planner/motion_planning/state_search.h"

namespace nbs {
namespace {

namespace ob = ompl::base;

using Space = ob::SE3StateSpace;

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
    rng_.setLocalSeed(CalcSamplerSeed(seed));
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

ob::StateSpacePtr MakeSpace(const Pose& X_WB_start, const Pose& X_WB_goal, const Se3SearchSettings& settings) {
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
  return space;
}

}  // namespace

std::vector<Pose> FindSe3Path(const Pose& X_WB_start, const Pose& X_WB_goal, const Se3SearchSettings& settings,
                              const PoseCheck& is_free, const MotionCheck& is_free_motion) {
  StateSearch search;
  search.is_free = [&](const ob::State* state) { return is_free(ToPose(state)); };
  search.is_free_motion = [&](const ob::State* from, const ob::State* to) {
    return is_free_motion(ToPose(from), ToPose(to));
  };
  search.set_start = [&](ob::State* state) { FromPose(X_WB_start, state); };
  search.set_goals = {[&](ob::State* state) { FromPose(X_WB_goal, state); }};
  search.range = settings.range_m;
  search.iterations = settings.iterations;
  search.shortcuts = settings.shortcuts;
  search.seed = settings.seed;
  std::vector<Pose> poses_WB;
  FindStateWay(MakeSpace(X_WB_start, X_WB_goal, settings), search, [&](const std::vector<const ob::State*>& way) {
    std::vector<Pose> offered_WB;
    for (const ob::State* state : way) offered_WB.push_back(ToPose(state));
    offered_WB.front() = X_WB_start;
    offered_WB.back() = X_WB_goal;
    if (!IsFreeWay(offered_WB, is_free_motion)) return false;
    poses_WB = std::move(offered_WB);
    return true;
  });
  return poses_WB;
}

}  // namespace nbs
