#pragma once

#include <cmath>

#include "common/config/run_config.h"
#include "common/mapping/voxel_grid.h"

namespace nbs {

/// A statue half scanned: an ellipsoid of 0.2 x 0.16 x 0.5 m in its unknown box. Its surface is occupied and the space
/// around it free on the side x > `seen_x_m`; the rest was never observed.
inline VoxelGrid MakeHalfScannedStatue(double seen_x_m) {
  VoxelGrid grid(GridShape{{-0.15, -0.13, -0.3}, 0.005, {60, 52, 120}});
  const GridShape& shape = grid.shape();
  const Eigen::Array3d radii(0.1, 0.08, 0.25);
  for (int z = 0; z < shape.size.z(); ++z) {
    for (int y = 0; y < shape.size.y(); ++y) {
      for (int x = 0; x < shape.size.x(); ++x) {
        const Eigen::Vector3d p_W = shape.origin_W + shape.resolution_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
        if (p_W.x() < seen_x_m) continue;
        const double level = (p_W.array() / radii).matrix().norm();
        const bool occupied = std::abs(level - 1.0) < 0.05;
        if (occupied || level > 1.0) grid.cells()[shape.Index(x, y, z)] = occupied ? 4000 : -4000;
      }
    }
  }
  return grid;
}

/// The cell `free` around a grid.
inline RunConfig MakeRunAround(const VoxelGrid& grid) {
  RunConfig config;
  config.grid = grid.shape();
  return config;
}

}  // namespace nbs
