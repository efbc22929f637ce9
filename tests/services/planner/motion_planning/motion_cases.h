#pragma once

#include <initializer_list>

#include "common/config/run_config.h"
#include "common/runtime/counter_random.h"
#include "tests/services/planner/motion_planning/box_world.h"

namespace nbs {

/// The cell `free` around a voxel space of 0.4 m about the origin.
inline RunConfig MakeFreeRun() {
  RunConfig config;
  config.grid.origin_W = Eigen::Vector3d::Constant(-0.2);
  config.grid.resolution_m = 0.005;
  config.grid.size = Eigen::Vector3i::Constant(80);
  return config;
}

/// A box in W from its lowest and its highest corner, metres.
inline Eigen::AlignedBox3d MakeBox(const Eigen::Vector3d& low_W, const Eigen::Vector3d& high_W) {
  return {low_W, high_W};
}

/// A block in the middle that hides its far side.
inline BoxWorld MakeBlockWorld() {
  BoxWorld world;
  world.occupied.push_back(MakeBox({-0.15, -0.15, -0.15}, {0.15, 0.15, 0.15}));
  return world;
}

/// A scan path of 0.3 m upwards that looks at the block from the direction of `angle_rad` about z, 0.35 m off its
/// middle.
inline ScanPath MakeUpwardPath(double angle_rad) {
  const Eigen::Vector3d out_W(std::cos(angle_rad), std::sin(angle_rad), 0.0);
  const Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
  return {MakeLookPose(0.35 * out_W - 0.15 * up_W, -out_W, up_W),
          MakeLookPose(0.35 * out_W + 0.15 * up_W, -out_W, up_W)};
}

/// A pose with even position in a box of 2 * `reach_m` about the origin and any orientation.
inline Pose MakeRandomPose(uint64_t seed, uint64_t number, double reach_m) {
  const auto draw = [&](uint64_t k) { return CalcUniform({seed, number, k}); };
  const Eigen::Vector3d p_W = reach_m * (2.0 * Eigen::Vector3d(draw(0), draw(1), draw(2)).array() - 1.0).matrix();
  const auto normal = [&](uint64_t k) { return CalcGaussian({seed, number, k}); };
  return MakePose(p_W, Eigen::Quaterniond(normal(3), normal(4), normal(5), normal(6)).normalized());
}

}  // namespace nbs
