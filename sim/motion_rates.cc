#include "sim/motion_rates.h"

#include <cmath>
#include <vector>

namespace nbs {
namespace {

constexpr double kSpeedTolerance = 0.01;
constexpr double kLimitTolerance_rad = 1e-9;
constexpr double kRounding = 1e-9;  // radians or metres
constexpr double kMicrosecond = 1e-6;

/// How far something came, and how fast it may.
struct Way {
  std::string body;
  double length = 0.0;  // radians or metres
  double speed = 0.0;   // the same a second
};

std::vector<Way> ListWays(const RobotBody& robot, const CellConfig& cell, const Posture& from, const Posture& to) {
  std::vector<Way> ways;
  if (robot.arm()) {
    for (int k = 0; k < robot.arm()->n(); ++k) {
      const ArmJoint& joint = robot.arm()->joints[static_cast<size_t>(k)];
      ways.push_back({joint.name, std::abs(to.q[k] - from.q[k]), joint.max_rad_per_s});
    }
  }
  const auto length_of = [](const Pose& X_WA, const Pose& X_WB) {
    return (X_WB.translation() - X_WA.translation()).norm();
  };
  ways.push_back({"flange", length_of(from.X_WF, to.X_WF), cell.move_speed_m_per_s});
  ways.push_back({"flange", CalcAngleBetween(from.X_WF, to.X_WF), cell.turn_speed_rad_per_s});
  if (from.scanning && to.scanning)
    ways.push_back({"sensor", length_of(from.X_WF * cell.X_FS, to.X_WF * cell.X_FS), cell.profiler.scan_speed_m_per_s});
  return ways;
}

}  // namespace

std::optional<std::string> FindJointFault(const RobotBody& robot, const Posture& posture) {
  if (!robot.arm()) return std::nullopt;
  for (int k = 0; k < robot.arm()->n(); ++k) {
    const ArmJoint& joint = robot.arm()->joints[static_cast<size_t>(k)];
    const double q = posture.q[k];
    if (!(q >= joint.min_rad - kLimitTolerance_rad && q <= joint.max_rad + kLimitTolerance_rad)) return joint.name;
  }
  return std::nullopt;
}

std::optional<RateFault> FindRateFault(const RobotBody& robot, const CellConfig& cell, const Posture& from,
                                       const Posture& to) {
  // Times are whole microseconds.
  const double duration_s = kMicrosecond * (static_cast<double>(to.utime_us - from.utime_us) + 1.0);
  const double period_s = 1.0 / cell.profiler.rate_hz;
  std::optional<RateFault> fault;
  for (const Way& way : ListWays(robot, cell, from, to)) {
    const double may = way.speed * duration_s;
    if (way.length > 2.0 * may + kRounding && way.length > way.speed * period_s)
      return RateFault{MotionFault::kJump, way.body};
    if (!fault && way.length > (1.0 + kSpeedTolerance) * may + kRounding) fault = {MotionFault::kSpeed, way.body};
  }
  return fault;
}

}  // namespace nbs
