#include "services/robot/robot_node.h"

#include <algorithm>

#include "services/robot/trajectory_sampler.h"

namespace nbs {

RobotNode::RobotNode(const RunConfig& config)
    : clock_(config.cell.profiler.rate_hz), limits_(MakeRobotLimits(config.cell)) {
  if (config.cell.robot != "arm") return;
  arm_ = MakeArmLimits(config);
  q_ = MakeJoints(config.cell.arm->start_rad);
  X_WF_ = arm_->X_WB * CalcFlangePose(arm_->model, q_);
}

std::string RobotNode::FindRefusal(const Trajectory& trajectory) const {
  if (arm_) return FindArmRefusal(trajectory, q_, *arm_);
  return nbs::FindRefusal(trajectory, X_WF_.value_or(Pose::Identity()), limits_);
}

/// An arm moves its joints evenly, not its flange.
RobotState RobotNode::MakeState(const Trajectory& trajectory, RobotState state, int64_t time_us) const {
  if (!arm_) return state;
  const Joints q = CalcJointValues(trajectory, time_us);
  state.X_WF = arm_->X_WB * CalcFlangePose(arm_->model, q);
  state.joints_rad.assign(q.begin(), q.end());
  return state;
}

void RobotNode::Handle(const Message& message, Outbox& out) {
  const auto& trajectory = std::get<Trajectory>(message);
  next_tick_ = std::max(next_tick_, clock_.FindTick(trajectory.utime_us));
  if (!X_WF_ && !trajectory.points.empty() && IsRigid(trajectory.points.front().X_WF))
    X_WF_ = trajectory.points.front().X_WF;
  std::string refusal = FindRefusal(trajectory);
  if (!refusal.empty()) {
    ++refused_;
    return Finish(trajectory, std::move(refusal), out);
  }
  const int64_t start_us = clock_.CalcTime(next_tick_);
  for (RobotState& state : SampleStates(trajectory, clock_, next_tick_)) {
    const int64_t time_us = state.utime_us - start_us;
    out.push_back(MakeState(trajectory, std::move(state), time_us));
    ++next_tick_;
  }
  X_WF_ = trajectory.points.back().X_WF;
  if (arm_) q_ = CalcJointValues(trajectory, trajectory.points.back().time_us);
  Finish(trajectory, {}, out);
}

void RobotNode::Finish(const Trajectory& trajectory, std::string refusal, Outbox& out) {
  const int64_t utime_us = clock_.CalcTime(next_tick_++);
  const std::vector<double> joints_rad = arm_ ? std::vector<double>(q_.begin(), q_.end()) : std::vector<double>();
  out.push_back(RobotState{utime_us, trajectory.scan, false, true, X_WF_.value_or(Pose::Identity()), joints_rad});
  out.push_back(Execution{utime_us, trajectory.scan, refusal.empty(), std::move(refusal)});
}

}  // namespace nbs
