#include "services/robot/trajectory_sampler.h"

#include <algorithm>

namespace nbs {
namespace {

using Points = std::vector<TrajectoryPoint>;

// The first point later than `time_us`.
Points::const_iterator FindNextPoint(const Points& points, int64_t time_us) {
  return std::upper_bound(points.begin(), points.end(), time_us,
                          [](int64_t time, const TrajectoryPoint& point) { return time < point.time_us; });
}

}  // namespace

Pose CalcFlangePose(const Trajectory& trajectory, int64_t time_us) {
  const Points& points = trajectory.points;
  const auto next = FindNextPoint(points, time_us);
  if (next == points.begin()) return points.front().X_WF;
  const TrajectoryPoint& last = *(next - 1);
  if (next == points.end() || last.time_us == time_us) return last.X_WF;
  const auto fraction = static_cast<double>(time_us - last.time_us) / static_cast<double>(next->time_us - last.time_us);
  return Interpolate(last.X_WF, next->X_WF, fraction);
}

bool IsScanning(const Trajectory& trajectory, int64_t time_us) {
  const Points& points = trajectory.points;
  const auto next = FindNextPoint(points, time_us);
  if (next == points.begin()) return false;
  const auto last = next - 1;
  if (next != points.end() && last->scanning) return true;
  return last->time_us == time_us && last != points.begin() && (last - 1)->scanning;
}

std::vector<RobotState> SampleStates(const Trajectory& trajectory, const ProfileClock& clock, int64_t first_tick) {
  const int64_t start_us = clock.CalcTime(first_tick);
  const int64_t end_us = start_us + trajectory.points.back().time_us;
  std::vector<RobotState> states;
  for (int64_t tick = first_tick; clock.CalcTime(tick) <= end_us; ++tick) {
    const int64_t utime_us = clock.CalcTime(tick);
    const int64_t time_us = utime_us - start_us;
    states.push_back(
        {utime_us, trajectory.scan, IsScanning(trajectory, time_us), false, CalcFlangePose(trajectory, time_us), {}});
  }
  return states;
}

}  // namespace nbs
