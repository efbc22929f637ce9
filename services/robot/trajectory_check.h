#pragma once

#include <string>

#include "common/config/run_config.h"
#include "common/planning/scan_path.h"

namespace nbs {

/// What a robot must not exceed and how exactly it wants to be told where it starts.
struct RobotLimits {
  double move_speed_m_per_s = 0.25;  ///< Of the flange's origin, everywhere.
  double scan_speed_m_per_s = 0.05;  ///< Of the sensor's origin, on scanning segments.
  double turn_speed_rad_per_s = 0.8;
  double speed_tolerance = 0.01;  ///< Share by which a speed may exceed its limit.
  double start_tolerance_m = 0.001;
  double start_tolerance_rad = 0.008726646259971648;  ///< 0.5 degrees.
  Pose X_FS = Pose::Identity();                       ///< Sensor in flange.
};

RobotLimits MakeRobotLimits(const CellConfig& cell);

/// Why nothing can execute the trajectory: no points, times that do not rise or pass a day, poses that are not rigid;
/// empty if they are sound.
std::string FindFormFault(const Trajectory& trajectory);

/// Where flange or scanning sensor are too fast; empty if nowhere.
///
/// @pre FindFormFault finds nothing.
std::string FindSpeedFault(const Trajectory& trajectory, const RobotLimits& limits);

/// Why a free-flying sensor that rests at X_WF cannot execute the trajectory, in one sentence; empty if it can.
///
/// Looked for, in this order: no points; times that do not rise or pass a day; poses that are not rigid; joints; a
/// start away from X_WF; segments that are too fast. Times are whole microseconds, so a segment counts as up to one
/// microsecond longer than it says.
std::string FindRefusal(const Trajectory& trajectory, const Pose& X_WF, const RobotLimits& limits);

}  // namespace nbs
