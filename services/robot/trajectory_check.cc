#include "services/robot/trajectory_check.h"

#include <fmt/format.h>

#include <string_view>

namespace nbs {
namespace {

constexpr int64_t kLongestMotion_us = 24ll * 3600 * 1'000'000;

std::string FindStartFault(const TrajectoryPoint& first, const Pose& X_WF, const RobotLimits& limits) {
  const double distance_m = (first.X_WF.translation() - X_WF.translation()).norm();
  const double angle_rad = CalcAngleBetween(first.X_WF, X_WF);
  if (distance_m <= limits.start_tolerance_m && angle_rad <= limits.start_tolerance_rad) return {};
  return fmt::format("The trajectory starts {:.3f} m and {:.4f} rad away from where the robot is.", distance_m,
                     angle_rad);
}

double CalcDistance(const Pose& X_WA, const Pose& X_WB) { return (X_WA.translation() - X_WB.translation()).norm(); }

std::string FindJoints(const Trajectory& trajectory) {
  for (size_t i = 0; i < trajectory.points.size(); ++i) {
    if (!trajectory.points[i].joints_rad.empty())
      return fmt::format("Point {} has joints, but a free-flying sensor has none.", i);
  }
  return {};
}

}  // namespace

std::string FindFormFault(const Trajectory& trajectory) {
  const auto& points = trajectory.points;
  if (points.empty()) return "The trajectory has no points.";
  for (size_t i = 0; i < points.size(); ++i) {
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

std::string FindSpeedFault(const Trajectory& trajectory, const RobotLimits& limits) {
  const auto& points = trajectory.points;
  for (size_t i = 1; i < points.size(); ++i) {
    const Pose& X_WF_from = points[i - 1].X_WF;
    const Pose& X_WF_to = points[i].X_WF;
    const double duration_s = 1e-6 * static_cast<double>(points[i].time_us - points[i - 1].time_us + 1);
    const auto explain = [&](std::string_view what, double speed, double limit, std::string_view unit) -> std::string {
      if (speed <= limit * (1.0 + limits.speed_tolerance)) return {};
      return fmt::format("Between points {} and {} it {} at {:.4f} {}; the limit is {:.4f} {}.", i - 1, i, what, speed,
                         unit, limit, unit);
    };
    std::string fault =
        explain("moves", CalcDistance(X_WF_from, X_WF_to) / duration_s, limits.move_speed_m_per_s, "m/s");
    if (fault.empty())
      fault = explain("turns", CalcAngleBetween(X_WF_from, X_WF_to) / duration_s, limits.turn_speed_rad_per_s, "rad/s");
    if (fault.empty() && points[i - 1].scanning) {
      const double scanned_m = CalcDistance(X_WF_from * limits.X_FS, X_WF_to * limits.X_FS);
      fault = explain("scans", scanned_m / duration_s, limits.scan_speed_m_per_s, "m/s");
    }
    if (!fault.empty()) return fault;
  }
  return {};
}

RobotLimits MakeRobotLimits(const CellConfig& cell) {
  RobotLimits limits;
  limits.move_speed_m_per_s = cell.move_speed_m_per_s;
  limits.scan_speed_m_per_s = cell.profiler.scan_speed_m_per_s;
  limits.turn_speed_rad_per_s = cell.turn_speed_rad_per_s;
  limits.X_FS = cell.X_FS;
  return limits;
}

std::string FindRefusal(const Trajectory& trajectory, const Pose& X_WF, const RobotLimits& limits) {
  std::string fault = FindFormFault(trajectory);
  if (fault.empty()) fault = FindJoints(trajectory);
  if (fault.empty()) fault = FindStartFault(trajectory.points.front(), X_WF, limits);
  if (fault.empty()) fault = FindSpeedFault(trajectory, limits);
  return fault;
}

}  // namespace nbs
