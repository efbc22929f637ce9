#include "services/robot/trajectory_check.h"

#include <fmt/format.h>

namespace nbs {
namespace {

constexpr int64_t kLongestMotion_us = 24ll * 3600 * 1'000'000;

std::string FindFormFault(const Trajectory& trajectory) {
  const auto& points = trajectory.points;
  if (points.empty()) return "The trajectory has no points.";
  for (size_t i = 0; i < points.size(); ++i) {
    if (!points[i].joints_rad.empty()) return fmt::format("Point {} has joints, but a free-flying sensor has none.", i);
    if (points[i].time_us < 0) return fmt::format("The time of point {}, {} us, is negative.", i, points[i].time_us);
    if (i > 0 && points[i].time_us <= points[i - 1].time_us) {
      return fmt::format("The time of point {}, {} us, is not later than that of the point before, {} us.", i,
                         points[i].time_us, points[i - 1].time_us);
    }
    if (points[i].time_us > kLongestMotion_us) return fmt::format("Point {} comes more than a day after the start.", i);
    if (!IsRigid(points[i].X_WF)) return fmt::format("The pose of point {} is no rigid transform.", i);
  }
  return {};
}

std::string FindStartFault(const TrajectoryPoint& first, const Pose& X_WF, const MotionLimits& limits) {
  const double distance_m = (first.X_WF.translation() - X_WF.translation()).norm();
  const double angle_rad = CalcAngleBetween(first.X_WF, X_WF);
  if (distance_m <= limits.start_tolerance_m && angle_rad <= limits.start_tolerance_rad) return {};
  return fmt::format("The trajectory starts {:.3f} m and {:.4f} rad away from where the robot is.", distance_m,
                     angle_rad);
}

std::string FindSpeedFault(const Trajectory& trajectory, const MotionLimits& limits) {
  const auto& points = trajectory.points;
  for (size_t i = 1; i < points.size(); ++i) {
    const double duration_s = 1e-6 * static_cast<double>(points[i].time_us - points[i - 1].time_us + 1);
    const bool scanning = points[i - 1].scanning;
    const double limit_m_per_s = scanning ? limits.scan_speed_m_per_s : limits.move_speed_m_per_s;
    const double speed_m_per_s = (points[i].X_WF.translation() - points[i - 1].X_WF.translation()).norm() / duration_s;
    if (speed_m_per_s > limit_m_per_s * (1.0 + limits.speed_tolerance)) {
      return fmt::format("Between points {} and {} it {} at {:.4f} m/s; the limit is {:.4f} m/s.", i - 1, i,
                         scanning ? "scans" : "moves", speed_m_per_s, limit_m_per_s);
    }
    const double turn_rad_per_s = CalcAngleBetween(points[i].X_WF, points[i - 1].X_WF) / duration_s;
    if (turn_rad_per_s > limits.turn_speed_rad_per_s * (1.0 + limits.speed_tolerance)) {
      return fmt::format("Between points {} and {} it turns at {:.4f} rad/s; the limit is {:.4f} rad/s.", i - 1, i,
                         turn_rad_per_s, limits.turn_speed_rad_per_s);
    }
  }
  return {};
}

}  // namespace

MotionLimits MakeMotionLimits(const CellConfig& cell) {
  MotionLimits limits;
  limits.move_speed_m_per_s = cell.move_speed_m_per_s;
  limits.scan_speed_m_per_s = cell.profiler.scan_speed_m_per_s;
  limits.turn_speed_rad_per_s = cell.turn_speed_rad_per_s;
  return limits;
}

std::string FindRefusal(const Trajectory& trajectory, const Pose& X_WF, const MotionLimits& limits) {
  std::string fault = FindFormFault(trajectory);
  if (fault.empty()) fault = FindStartFault(trajectory.points.front(), X_WF, limits);
  if (fault.empty()) fault = FindSpeedFault(trajectory, limits);
  return fault;
}

}  // namespace nbs
