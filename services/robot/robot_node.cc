#include "services/robot/robot_node.h"

#include <algorithm>

#include "common/runtime/error.h"
#include "services/robot/trajectory_sampler.h"

namespace nbs {

RobotNode::RobotNode(const RunConfig& config)
    : clock_(config.cell.profiler.rate_hz), limits_(MakeRobotLimits(config.cell)) {
  if (config.cell.robot != "free") {
    throw ConfigError("The cell " + config.cell.name + " has the robot \"" + config.cell.robot +
                      "\", but only \"free\" can be simulated.");
  }
}

void RobotNode::Handle(const Message& message, Outbox& out) {
  const auto& trajectory = std::get<Trajectory>(message);
  next_tick_ = std::max(next_tick_, clock_.FindTick(trajectory.utime_us));
  if (!X_WF_ && !trajectory.points.empty() && IsRigid(trajectory.points.front().X_WF))
    X_WF_ = trajectory.points.front().X_WF;
  std::string refusal = FindRefusal(trajectory, X_WF_.value_or(Pose::Identity()), limits_);
  if (!refusal.empty()) {
    ++refused_;
    return Finish(trajectory, std::move(refusal), out);
  }
  for (RobotState& state : SampleStates(trajectory, clock_, next_tick_)) {
    out.push_back(std::move(state));
    ++next_tick_;
  }
  X_WF_ = trajectory.points.back().X_WF;
  Finish(trajectory, {}, out);
}

void RobotNode::Finish(const Trajectory& trajectory, std::string refusal, Outbox& out) {
  const int64_t utime_us = clock_.CalcTime(next_tick_++);
  out.push_back(RobotState{utime_us, trajectory.scan, false, true, X_WF_.value_or(Pose::Identity()), {}});
  out.push_back(Execution{utime_us, trajectory.scan, refusal.empty(), std::move(refusal)});
}

}  // namespace nbs
