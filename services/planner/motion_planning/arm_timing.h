#pragma once

#include <span>
#include <vector>

#include "common/kinematics/arm_model.h"
#include "common/planning/scan_path.h"
#include "services/planner/motion_planning/timing.h"

namespace nbs {

/// What an arm's motion keeps everywhere.
struct ArmTimingLimits {
  std::vector<double> rad_per_s;
  std::vector<double> rad_per_s2;
  Pose X_FS = Pose::Identity();  ///< The sensor, whose speed counts along a scan path.
  TimingLimits flange;           ///< Between scans; scan_m_per_s along them.
  double scan_m_per_s2 = 0.25;   ///< Acceleration of the sensor at either end of a scan path.
  double piece_s = 0.06;         ///< Longest piece of a ramp; a trajectory's points are joined by straight lines.
};

/// Puts times to an arm's motion: the approach, at rest at each of its joint values, then the scan path at the scan
/// speed.
///
/// Each straight line of the approach is a trapezoid of speed that all joints share, as fast as the limits of joints
/// and flange allow. The scan begins on a multiple of the profile period; the sensor speeds up and slows down within
/// it.
///
/// Where slow accelerations make more points than one message holds (CalcMostPoints), the ramps of the approach are cut
/// into pieces of twice piece_s, four times, and so on, as far as needed: the way stays the same straight lines, and
/// each piece keeps all limits. Too many corners make too many points all the same.
///
/// Near a singularity a joint turns fast although the sensor creeps: where it would have to gather speed too fast, the
/// ramps of the scan are made longer, and if that does not do, the scan slower.
///
/// @param X_WB      The arm's base.
/// @param approach  From the current joint values to scan.front(); at least the current ones.
/// @param scan      Joint values at even fractions of the scan path, at least two.
/// @param length_m  Length of the sensor's way along the scan path; without length it lasts one profile period.
/// @returns A trajectory with joints, flange poses that belong to them, utime_us and scan 0.
Trajectory MakeArmTrajectory(const ArmModel& model, const Pose& X_WB, const ArmTimingLimits& limits,
                             std::span<const Joints> approach, std::span<const Joints> scan, double length_m);

/// The largest share of its limit that the acceleration of a joint takes, from point to point and at either end; the
/// robot refuses what is above 1.05.
double CalcAccelerationShare(const Trajectory& trajectory, std::span<const double> rad_per_s2);

/// What a trajectory may take of it.
constexpr double kMostAccelerationShare = 1.04;

/// Time of a straight line in joint space at the limits of speed and acceleration, from rest to rest, seconds.
double CalcJointTime(const ArmModel& model, const ArmTimingLimits& limits, const Joints& q_from, const Joints& q_to);

}  // namespace nbs
