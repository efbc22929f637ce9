#pragma once

#include <cstdint>
#include <optional>

#include "common/config/run_config.h"
#include "common/runtime/node.h"
#include "services/robot/arm_check.h"
#include "services/robot/profile_clock.h"
#include "services/robot/trajectory_check.h"

namespace nbs {

/// The simulated robot, a free-flying sensor or an arm: TRAJECTORY in, ROBOT_STATE and then EXECUTION out.
///
/// A trajectory starts at the first tick of the profile clock at or after its time, and later than every state before.
/// The robot publishes a state at every tick, one last state with end_of_scan at the tick after the motion, and then
/// what became of the trajectory. A refused trajectory gives the last state alone, so that every service closes the
/// scan, and the reason. An arm rests at the cell's joint values before its first trajectory; a free-flying sensor is
/// where the first point of its first trajectory says. What an arm reports is where its joints say that the flange is;
/// where it truly is only the simulated world knows.
class RobotNode : public Node {
 public:
  /// @throws ConfigError if the URDF of an arm cannot be used.
  explicit RobotNode(const RunConfig& config);

  size_t NextInput() const override { return StreamOf<Trajectory>(); }
  void Handle(const Message& message, Outbox& out) override;

  /// trajectory_refused.
  std::vector<Count> Complaints() const override { return {{"trajectory_refused", refused_}}; }

 private:
  std::string FindRefusal(const Trajectory& trajectory) const;
  RobotState MakeState(const Trajectory& trajectory, RobotState state, int64_t time_us) const;
  void Finish(const Trajectory& trajectory, std::string refusal, Outbox& out);

  ProfileClock clock_;
  RobotLimits limits_;
  std::optional<ArmLimits> arm_;
  Joints q_;                  ///< Where the arm rests.
  std::optional<Pose> X_WF_;  ///< Where the robot rests; nullopt before the first trajectory.
  int64_t next_tick_ = 0;     ///< The first tick without a state.
  int64_t refused_ = 0;
};

}  // namespace nbs
