#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/config/run_config.h"
#include "services/planner/motion_planning/collision_body.h"
#include "services/planner/motion_planning/motion_backend.h"
#include "services/planner/motion_planning/motion_settings.h"
#include "services/planner/motion_planning/timing.h"

namespace nbs {

/// The free-flying sensor of section IV-B: a rigid body without joints and without a limit of its work space.
///
/// The way to a scan path is straight if that is free, otherwise found by FindSe3Path. A path may be driven from either
/// end and with the sensor rolled by half a turn; the start that takes the shortest time to reach straight goes first.
class FreeMotion final : public MotionBackend {
 public:
  FreeMotion(const RunConfig& config, const MotionSettings& settings);

  PathCheck CheckPath(const Clearance& clearance, const ScanPath& path) const override;
  MotionResult Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                    uint64_t seed) const override;

 private:
  /// One way to drive a scan path.
  struct Drive {
    ScanPath path;
    std::vector<Pose> poses_WF;
  };

  std::vector<Drive> MakeDrives(const std::vector<ScanPath>& paths, const Pose& X_WF_from) const;
  MotionResult PlanAbove(const Clearance& clearance, const Pose& X_WS_now, const ScanPath& path, uint64_t seed) const;
  std::vector<Pose> FindWay(const Clearance& clearance, const Pose& X_WF_from, const Pose& X_WF_to,
                            uint64_t seed) const;
  MotionResult MakeResult(Verdict verdict, const std::vector<Pose>& approach_WF, const Drive& drive) const;

  MotionSettings settings_;
  Pose X_FS_;
  std::optional<double> table_z_m_;
  bool half_turns_;  ///< A sensor rolled by half a turn sees the same.
  CollisionBody body_F_;
  TimingLimits limits_;
  Eigen::AlignedBox3d search_box_W_;
};

}  // namespace nbs
