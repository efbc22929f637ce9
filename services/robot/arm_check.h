#pragma once

#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "common/kinematics/arm_model.h"
#include "services/robot/trajectory_check.h"

namespace nbs {

/// What an arm must not exceed and how exactly it wants to be told where it starts.
struct ArmLimits {
  ArmModel model;
  Pose X_WB = Pose::Identity();
  std::vector<double> max_rad_per_s2;
  RobotLimits flange;                    ///< Speeds of the flange and of the sensor.
  double acceleration_tolerance = 0.05;  ///< Share; points are joined by straight lines, whose corners are sharper.
  double start_tolerance_rad = 0.001;
  double pose_tolerance_m = 0.001;  ///< Between a point's pose and its joints.
};

/// @throws ConfigError if the URDF cannot be used.
/// @pre The run has an arm.
ArmLimits MakeArmLimits(const RunConfig& config);

/// Why an arm that rests at `q_now` cannot execute the trajectory, in one sentence; empty if it can.
///
/// Looked for, in this order: no points; times that do not rise or pass a day; joint values that are missing, not
/// finite or beyond the limits; poses that do not belong to their joints; a start away from q_now; joints that turn too
/// fast, or change their speed too fast (it starts and ends at rest); a flange or a scanning sensor that is too fast.
std::string FindArmRefusal(const Trajectory& trajectory, const Joints& q_now, const ArmLimits& limits);

/// Joint values at a time of the trajectory: straight and even between two points.
Joints CalcJointValues(const Trajectory& trajectory, int64_t time_us);

}  // namespace nbs
