#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/planning/scan_path.h"
#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// Where the robot is.
struct RobotPosture {
  RobotPosture(const Pose& X_WS_now, std::vector<double> joints = {}) : X_WS(X_WS_now), joints_rad(std::move(joints)) {}

  Pose X_WS = Pose::Identity();
  std::vector<double> joints_rad;  ///< Empty for a free-flying sensor.
};

/// Whether a scan path can be driven, whatever the way to it.
struct PathCheck {
  Verdict verdict = Verdict::kReachable;  ///< kReachable, kPartly, kBlockedByObstacle, kBlockedByUnknown; of an arm
                                          ///< also what its joints do not allow.
  ScanPath path;  ///< What can be driven: the path as given, rolled, or the longest part of it. As given when blocked.
};

/// A motion, or why there is none.
struct MotionResult {
  Verdict verdict = Verdict::kNoMotion;  ///< As in PathCheck; kNoMotion if the scan path could be driven, but no way to
                                         ///< its start was found.
  ScanPath path;          ///< What is driven, in the direction in which it is driven; as given if there is no motion.
  Trajectory trajectory;  ///< Empty unless the verdict is kReachable or kPartly. utime_us and scan are left at 0.

  bool found() const { return !trajectory.points.empty(); }
};

/// How one kind of robot moves the sensor.
class MotionBackend {
 public:
  virtual ~MotionBackend() = default;
  /// Called by several threads at a time.
  virtual PathCheck CheckPath(const Clearance& clearance, const ScanPath& path) const = 0;
  /// True if a check takes so long that threads are worth their start.
  virtual bool ChecksSlowly() const { return false; }
  /// False if the robot could not be in the middle of the path, or at one of its ends even in empty space.
  virtual bool CouldDrive(const Clearance& /*clearance*/, const ScanPath& /*path*/) const { return true; }
  virtual MotionResult Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                            uint64_t seed) const = 0;
  /// Where the robot is before its first motion.
  virtual RobotPosture MakeStartPosture(const ScanPath& first_path) const { return {first_path.X_WS_start, {}}; }
  /// Why a run cannot begin, in words; empty if it can.
  virtual std::string FindStartFault(const Clearance& /*clearance*/, const ScanPath& /*first_path*/) const {
    return {};
  }
};

}  // namespace nbs
