#pragma once

#include "common/config/run_config.h"
#include "tests/services/planner/motion_planning/box_world.h"
#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {

/// The cell `kr16` around an object of 0.2 x 0.2 x 0.5 m that stands on the origin.
inline RunConfig MakeKr16Run() {
  RunConfig config;
  config.cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/kr16.yaml");
  ResolvePlacement({Eigen::Vector3d(-0.1, -0.1, 0.0), Eigen::Vector3d(0.1, 0.1, 0.5)}, config);
  return config;
}

/// The same with another arm, of which the object stands 0.7 m in front.
inline RunConfig MakeSmallArmRun() {
  RunConfig config = MakeKr16Run();
  ArmConfig& arm = *config.cell.arm;
  arm.urdf = std::filesystem::path(NBS_SOURCE_DIR) / "tests/common/kinematics/irb120.urdf";
  arm.base_link = "base";
  arm.start_rad = {0, -0.6, 0.4, 0, 0.8, 0};
  arm.X_OB.translation() = Eigen::Vector3d(-0.7, 0, 0);
  config.cell.X_FS = MakePose({0, 0, 0.08}, Eigen::Quaterniond::Identity());
  config.cell.sensor_body_S = {{{0, 0, -0.04}, 0.03}};
  config.cell.table_half_m = {0.2, 0.2};
  ResolvePlacement({Eigen::Vector3d(-0.05, -0.05, 0.0), Eigen::Vector3d(0.05, 0.05, 0.2)}, config);
  return config;
}

/// The object's own box, occupied, with nothing unknown around it.
inline BoxWorld MakeObjectWorld() {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-0.1, -0.1, 0.0}, {0.1, 0.1, 0.5}));
  return world;
}

/// A scan path of 0.2 m upwards that looks at the object's axis from the direction of `angle_rad` about z; 0 is the
/// side away from the arm.
inline ScanPath MakePathAbout(double angle_rad, double radius_m = 0.42, double low_m = 0.2) {
  const Eigen::Vector3d out_W(std::cos(angle_rad), std::sin(angle_rad), 0.0);
  const Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
  return {MakeLookPose(radius_m * out_W + low_m * up_W, -out_W, up_W),
          MakeLookPose(radius_m * out_W + (low_m + 0.2) * up_W, -out_W, up_W)};
}

}  // namespace nbs
