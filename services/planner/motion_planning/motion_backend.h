#pragma once

#include <cstdint>

#include "common/planning/scan_path.h"
#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// Whether a scan path can be driven, whatever the way to it.
struct PathCheck {
  Verdict verdict =
      Verdict::kReachable;  ///< kReachable, kPartly, kBlockedByObstacle, kBlockedByUnknown or kOutOfWorkspace.
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
  virtual PathCheck CheckPath(const Clearance& clearance, const ScanPath& path) const = 0;
  virtual MotionResult Plan(const Clearance& clearance, const Pose& X_WS_now, const ScanPath& path,
                            uint64_t seed) const = 0;
};

}  // namespace nbs
