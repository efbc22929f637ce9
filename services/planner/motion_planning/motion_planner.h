#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/config/run_config.h"
#include "services/planner/motion_planning/motion_backend.h"
#include "services/planner/motion_planning/motion_settings.h"

namespace nbs {

/// Decides whether a scan path can be driven and plans the motion for it (section III-E): approach and scan, with
/// times.
///
/// - A path that touches something occupied is blocked for good, one that touches unknown space for now; if a part of
/// it is free, that part stands for it.
/// - Every state of a trajectory keeps the cell's margin to anything occupied or unknown, less half a millimetre. Only
/// a robot that already stands nearer
///   begins with a short motion away.
/// - The same request gives the same trajectory, bit for bit; what was planned before does not matter.
class MotionPlanner {
 public:
  using Result = MotionResult;

  /// Chooses the backend after config.cell.robot.
  ///
  /// @throws std::invalid_argument if the robot has no backend, or the cell's speeds or body are out of range.
  /// @throws ConfigError if the URDF of an arm cannot be used, or does not fit the cell.
  explicit MotionPlanner(const RunConfig& config, const MotionSettings& settings = {});
  ~MotionPlanner();
  MotionPlanner(MotionPlanner&&) noexcept;
  MotionPlanner& operator=(MotionPlanner&&) noexcept;

  /// Whether the scan path itself can be driven; much cheaper than Plan, and independent of where the robot is.
  ///
  /// @throws std::invalid_argument if a pose is not rigid.
  [[nodiscard]] PathCheck CheckPath(const Clearance& clearance, const ScanPath& path) const;

  /// The same for several paths. Where a check is slow they are shared among threads, which do not change what is
  /// found.
  ///
  /// @param threads  At least 1.
  [[nodiscard]] std::vector<PathCheck> CheckPaths(const Clearance& clearance, std::span<const ScanPath> paths,
                                                  int threads) const;

  /// True if a check takes so long that it is worth to check several at a time.
  bool ChecksSlowly() const;

  /// Whether the robot could be in the middle of the path, and at both ends if space were empty but for what the cell
  /// puts there: a first sieve, much cheaper than CheckPath. What is cut off at its ends leaves a path that can be
  /// driven in part. A free-flying sensor always could.
  [[nodiscard]] bool CouldDrive(const Clearance& clearance, const ScanPath& path) const {
    return backend_->CouldDrive(clearance, path);
  }

  /// Where the robot is before its first motion: the cell's joint values, or at the start of the first path.
  RobotPosture MakeStartPosture(const ScanPath& first_path) const;

  /// Checks that a run can begin: the robot is free where it starts and can drive the first scan path.
  ///
  /// @param clearance  Of the voxel space at the start.
  /// @throws ConfigError otherwise, in one sentence.
  void CheckStart(const Clearance& clearance, const ScanPath& first_path) const;

  /// Plans from where the robot is to the scan path and along it.
  ///
  /// The path may be driven from either end, and with the sensor rolled by half a turn, which scans the same;
  /// Result::path says how. A motion of more points than one message holds (CalcMostPoints) is none: kNoMotion.
  ///
  /// @param seed  Of the search, where one is needed.
  /// @throws std::invalid_argument if a pose is not rigid.
  [[nodiscard]] Result Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                            uint64_t seed) const;

 private:
  std::string cell_;
  std::unique_ptr<const MotionBackend> backend_;
};

}  // namespace nbs
