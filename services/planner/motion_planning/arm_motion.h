#pragma once

#include "services/planner/motion_planning/arm_reach.h"
#include "services/planner/motion_planning/arm_timing.h"
#include "services/planner/motion_planning/motion_backend.h"
#include "services/planner/motion_planning/motion_settings.h"

namespace nbs {

/// A six-axis arm that carries the sensor (section IV-C), from its URDF.
///
/// A scan path is driven by continuous inverse kinematics, from either end, with the sensor's roll as the stripe
/// allows. The way to it is a straight line in joint space if that is free, otherwise found by RRT-Connect or PRM.
class ArmMotion final : public MotionBackend {
 public:
  /// @throws ConfigError if the URDF cannot be used, or does not fit the cell.
  ArmMotion(const RunConfig& config, const MotionSettings& settings);

  PathCheck CheckPath(const Clearance& clearance, const ScanPath& path) const override;
  bool ChecksSlowly() const override { return true; }
  bool CouldDrive(const Clearance& clearance, const ScanPath& path) const override;
  MotionResult Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                    uint64_t seed) const override;
  RobotPosture MakeStartPosture(const ScanPath& first_path) const override;
  std::string FindStartFault(const Clearance& clearance, const ScanPath& first_path) const override;

 private:
  std::string FindPathFault(const Clearance& clearance, const ScanPath& first_path) const;
  std::optional<Joints> FindEscape(const Clearance& clearance, const Joints& q_now) const;
  std::vector<Joints> FindWay(const Clearance& clearance, const Joints& q_from, const std::vector<ArmDrive>& drives,
                              uint64_t seed, size_t& drive) const;

  MotionSettings settings_;
  SearchAlgorithm search_;
  ArmReachSettings reach_;
  ArmSetup arm_;
  ArmTimingLimits limits_;
  Joints q_start_;
};

}  // namespace nbs
