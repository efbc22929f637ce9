#include "services/robot/arm_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/config/cell_arm.h"

namespace nbs {
namespace {

Joints JointsOf(const TrajectoryPoint& point) { return MakeJoints(point.joints_rad); }

std::string FindJointFault(const Trajectory& trajectory, const ArmLimits& limits) {
  for (size_t i = 0; i < trajectory.points.size(); ++i) {
    const TrajectoryPoint& point = trajectory.points[i];
    if (point.joints_rad.size() != limits.model.joints.size()) {
      return fmt::format("Point {} has {} joint values, but the arm has {} joints.", i, point.joints_rad.size(),
                         limits.model.joints.size());
    }
    for (size_t k = 0; k < limits.model.joints.size(); ++k) {
      const ArmJoint& joint = limits.model.joints[k];
      const double q = point.joints_rad[k];
      if (q >= joint.min_rad && q <= joint.max_rad) continue;
      return fmt::format("Point {} has {} at {:.4f} rad; its limits are {:.4f} and {:.4f} rad.", i, joint.name, q,
                         joint.min_rad, joint.max_rad);
    }
    const Pose X_WF = limits.X_WB * CalcFlangePose(limits.model, JointsOf(point));
    const double off_m = (X_WF.translation() - point.X_WF.translation()).norm();
    if (off_m > limits.pose_tolerance_m || CalcAngleBetween(X_WF, point.X_WF) > limits.flange.start_tolerance_rad)
      return fmt::format("The pose of point {} is not that of its joints: the flange is {:.4f} m off.", i, off_m);
  }
  return {};
}

std::string FindArmStartFault(const Trajectory& trajectory, const Joints& q_now, const ArmLimits& limits) {
  const Joints off = (JointsOf(trajectory.points.front()) - q_now).cwiseAbs();
  for (int k = 0; k < limits.model.n(); ++k) {
    if (off[k] <= limits.start_tolerance_rad) continue;
    return fmt::format("The trajectory starts with {} {:.4f} rad away from where the arm is.",
                       limits.model.joints[static_cast<size_t>(k)].name, off[k]);
  }
  return {};
}

/// Speeds and accelerations of the straight lines between points; at rest before the first and after the last.
std::string FindRateFault(const Trajectory& trajectory, const ArmLimits& limits) {
  const auto& points = trajectory.points;
  Joints speed_before = Joints::Zero(limits.model.n());
  double duration_before = 0.0;
  for (size_t i = 1; i <= points.size(); ++i) {
    const bool moves = i < points.size();
    const double duration_s = moves ? 1e-6 * static_cast<double>(points[i].time_us - points[i - 1].time_us + 1) : 0.0;
    Joints speed = Joints::Zero(limits.model.n());
    if (moves) speed = (JointsOf(points[i]) - JointsOf(points[i - 1])) / duration_s;
    const double change_s = 0.5 * (duration_s + duration_before);
    for (int k = 0; k < limits.model.n(); ++k) {
      const ArmJoint& joint = limits.model.joints[static_cast<size_t>(k)];
      if (std::abs(speed[k]) > joint.max_rad_per_s * (1.0 + limits.flange.speed_tolerance)) {
        return fmt::format("Between points {} and {} {} turns at {:.4f} rad/s; its limit is {:.4f} rad/s.", i - 1, i,
                           joint.name, std::abs(speed[k]), joint.max_rad_per_s);
      }
      const double limit = limits.max_rad_per_s2[static_cast<size_t>(k)];
      const double acceleration = std::abs(speed[k] - speed_before[k]) / change_s;
      if (acceleration > limit * (1.0 + limits.acceleration_tolerance)) {
        return fmt::format("At point {} {} changes its speed by {:.3f} rad/s2; its limit is {:.3f} rad/s2.", i - 1,
                           joint.name, acceleration, limit);
      }
    }
    speed_before = speed;
    duration_before = duration_s;
  }
  return {};
}

}  // namespace

ArmLimits MakeArmLimits(const RunConfig& config) {
  const ArmConfig& arm = config.cell.arm.value();
  ArmLimits limits;
  limits.model = ReadCellArm(config.cell);
  limits.X_WB = CalcBasePose(config);
  limits.max_rad_per_s2 = arm.max_rad_per_s2;
  limits.flange = MakeRobotLimits(config.cell);
  return limits;
}

std::string FindArmRefusal(const Trajectory& trajectory, const Joints& q_now, const ArmLimits& limits) {
  std::string fault = FindFormFault(trajectory);
  if (fault.empty()) fault = FindJointFault(trajectory, limits);
  if (fault.empty()) fault = FindArmStartFault(trajectory, q_now, limits);
  if (fault.empty()) fault = FindRateFault(trajectory, limits);
  if (fault.empty()) fault = FindSpeedFault(trajectory, limits.flange);
  return fault;
}

Joints CalcJointValues(const Trajectory& trajectory, int64_t time_us) {
  const auto& points = trajectory.points;
  const auto next = std::upper_bound(points.begin(), points.end(), time_us,
                                     [](int64_t time, const TrajectoryPoint& point) { return time < point.time_us; });
  if (next == points.begin()) return JointsOf(points.front());
  const TrajectoryPoint& last = *(next - 1);
  if (next == points.end() || last.time_us == time_us) return JointsOf(last);
  const auto share = static_cast<double>(time_us - last.time_us) / static_cast<double>(next->time_us - last.time_us);
  return JointsOf(last) + share * (JointsOf(*next) - JointsOf(last));
}

}  // namespace nbs
