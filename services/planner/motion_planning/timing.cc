#include "services/planner/motion_planning/timing.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

constexpr double kLargestTurn = 1.5;  // rad

double CheckPositive(const char* name, double value) {
  if (value > 0.0 && std::isfinite(value)) return value;
  throw std::invalid_argument(std::string("MakeLimits: ") + name + " is " + std::to_string(value));
}

bool IsSame(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

/// Appends the motion from the last point to X_WF, which takes at least `duration_s`.
void Append(const TimingLimits& limits, const Pose& X_WF, double duration_s, bool scanning,
            std::vector<TrajectoryPoint>& points) {
  const TrajectoryPoint from = points.back();
  const int n = std::max(1, static_cast<int>(std::ceil(CalcAngleBetween(from.X_WF, X_WF) / kLargestTurn)));
  points.back().scanning = scanning;
  Pose X_WF_last = from.X_WF;
  int64_t time_us = from.time_us;
  for (int k = 1; k <= n; ++k) {
    const Pose X_WF_k = k == n ? X_WF : Interpolate(from.X_WF, X_WF, static_cast<double>(k) / n);
    const double piece_s = std::max(duration_s / n, CalcMotionTime(limits, X_WF_last, X_WF_k));
    time_us += std::max<int64_t>(1, static_cast<int64_t>(std::ceil(piece_s * 1e6)));
    points.push_back({time_us, X_WF_k, {}, scanning && k < n});
    X_WF_last = X_WF_k;
  }
}

int64_t RoundUp(int64_t value, int64_t step) { return (value + step - 1) / step * step; }

}  // namespace

TimingLimits MakeLimits(const CellConfig& cell) {
  TimingLimits limits;
  limits.move_m_per_s = CheckPositive("move_speed_m_per_s", cell.move_speed_m_per_s);
  limits.turn_rad_per_s = CheckPositive("turn_speed_rad_per_s", cell.turn_speed_rad_per_s);
  limits.scan_m_per_s = CheckPositive("profiler.scan_speed_m_per_s", cell.profiler.scan_speed_m_per_s);
  limits.profile_period_us =
      std::max<int64_t>(1, std::llround(1e6 / CheckPositive("profiler.rate_hz", cell.profiler.rate_hz)));
  return limits;
}

double CalcMotionTime(const TimingLimits& limits, const Pose& X_WF_start, const Pose& X_WF_end) {
  const double way_m = (X_WF_end.translation() - X_WF_start.translation()).norm();
  return std::max(way_m / limits.move_m_per_s, CalcAngleBetween(X_WF_start, X_WF_end) / limits.turn_rad_per_s);
}

Trajectory MakeTrajectory(const TimingLimits& limits, std::span<const Pose> approach_WF, std::span<const Pose> scan_WF,
                          double scan_length_m) {
  if (approach_WF.empty() || scan_WF.size() < 2) throw std::invalid_argument("MakeTrajectory: too few poses");
  Trajectory trajectory;
  std::vector<TrajectoryPoint>& points = trajectory.points;
  points.push_back({0, approach_WF.front(), {}, false});
  for (const Pose& X_WF : approach_WF.subspan(1)) {
    if (!IsSame(X_WF, points.back().X_WF)) Append(limits, X_WF, 0.0, false, points);
  }
  points.back().time_us = RoundUp(points.back().time_us, limits.profile_period_us);

  const auto pieces = static_cast<double>(scan_WF.size() - 1);
  const double period_s = static_cast<double>(limits.profile_period_us) * 1e-6;
  const double sensor_s = std::max(period_s, scan_length_m / limits.scan_m_per_s) / pieces;
  for (const Pose& X_WF : scan_WF.subspan(1)) {
    const double way_m = (X_WF.translation() - points.back().X_WF.translation()).norm();
    Append(limits, X_WF, std::max(sensor_s, way_m / limits.scan_m_per_s), true, points);
  }
  return trajectory;
}

}  // namespace nbs
