#pragma once

#include <cstdint>
#include <vector>

#include "common/planning/scan_path.h"
#include "services/robot/profile_clock.h"

namespace nbs {

/// Flange in world at a time of the trajectory: straight and even between two points, exact at a point, at rest before
/// the first and after the last.
///
/// @param trajectory  At least one point, times rising.
/// @param time_us     Since the start of the trajectory.
Pose CalcFlangePose(const Trajectory& trajectory, int64_t time_us);

/// True if the time lies in a scanning segment, both of its ends included.
bool IsScanning(const Trajectory& trajectory, int64_t time_us);

/// The robot's states while it executes a trajectory: one at every tick of the profile clock from `first_tick`, when
/// the trajectory starts, to the last tick at which it still moves. A tick that ends one scanning segment and begins
/// the next gives one state.
///
/// @param trajectory  At least one point, times rising.
std::vector<RobotState> SampleStates(const Trajectory& trajectory, const ProfileClock& clock, int64_t first_tick);

}  // namespace nbs
