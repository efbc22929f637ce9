#pragma once

#include <cstdint>
#include <span>

#include "common/config/run_config.h"
#include "common/planning/scan_path.h"

namespace nbs {

/// Speeds that a trajectory keeps everywhere; all > 0.
struct TimingLimits {
  double move_m_per_s = 0.25;  ///< Of the flange's origin.
  double turn_rad_per_s = 0.8;
  double scan_m_per_s = 0.05;  ///< Of the sensor's and of the flange's origin along a scan path.
  int64_t profile_period_us = 40000;
};

/// @throws std::invalid_argument if a speed or the profile rate of the cell is not positive and finite.
TimingLimits MakeLimits(const CellConfig& cell);

/// Time of a straight, evenly turning motion at the limits of move and turn, whichever is slower: seconds.
double CalcMotionTime(const TimingLimits& limits, const Pose& X_WF_start, const Pose& X_WF_end);

/// Puts times to an approach and the scan path that follows.
///
/// Times rise strictly from 0 and are rounded up, so that no limit is exceeded between two points. The scan path begins
/// on a multiple of the profile period, so that a profile is taken at its very beginning (the robot starts a trajectory
/// on its profile clock); the approach's last motion is the slower for it. A scan path without length lasts one period.
/// A motion that turns by more than a quarter is given points on its way: half a turn would have no shortest way round.
/// Every point that begins a piece of the scan path has `scanning`; the last point has not.
///
/// @param approach_WF    From the current pose to scan_WF.front(); at least the current pose.
/// @param scan_WF        Poses at even fractions of the scan path, at least two.
/// @param scan_length_m  Length of the sensor's way along the scan path.
/// @returns A trajectory with utime_us and scan 0.
Trajectory MakeTrajectory(const TimingLimits& limits, std::span<const Pose> approach_WF, std::span<const Pose> scan_WF,
                          double scan_length_m);

}  // namespace nbs
