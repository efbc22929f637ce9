#pragma once

#include <cstdint>
#include <vector>

#include "common/kinematics/arm_model.h"
#include "common/mapping/distance_field.h"
#include "common/mapping/voxel_grid.h"

namespace nbs {

/// The obstacle cells of a voxel grid, and over them, level by level, cubes of 2, 4, 8 … cells that hold any: tells
/// exactly whether a body touches a cell.
///
/// Cells are closed cubes; everything outside of the grid is free. From the top down only cubes are looked into that
/// the body's surface passes: a cube out of its reach is passed over, one that lies in the body decides.
class ObstaclePyramid {
 public:
  /// @param free_max_probability  A cell is known to be free up to this p.
  ObstaclePyramid(const VoxelGrid& grid, Obstacles obstacles, double free_max_probability);

  /// True if an obstacle cell lies nearer to the line AB than the capsule's radius.
  bool IsTouched(const Capsule& capsule_W) const;

  /// True if an obstacle cell lies nearer to the block than `margin_m`.
  ///
  /// @param block_W  In the world frame: X_LC is X_WC.
  bool IsTouched(const Block& block_W, double margin_m) const;

 private:
  struct Level {
    Eigen::Vector3i size = Eigen::Vector3i::Zero();  ///< Cubes.
    std::vector<uint8_t> any;                        ///< x fastest.

    size_t Index(const Eigen::Vector3i& at) const {
      return (static_cast<size_t>(at.z()) * size.y() + at.y()) * size.x() + at.x();
    }
  };

  bool IsObstacle(int16_t log_odds) const {
    return obstacles_ == Obstacles::kOccupied ? IsOccupied(log_odds) : log_odds > free_ || log_odds == kUnobserved;
  }
  bool HasAny(size_t level, const Eigen::Vector3i& at) const {
    return level == 0 ? IsObstacle(grid_.At(at.x(), at.y(), at.z()))
                      : levels_[level - 1].any[levels_[level - 1].Index(at)] != 0;
  }
  const Eigen::Vector3i& SizeOf(size_t level) const {
    return level == 0 ? grid_.shape().size : levels_[level - 1].size;
  }
  template <typename Body>
  bool IsTouched(const Body& body, size_t level, const Eigen::Vector3i& at) const;
  Eigen::Vector3d ToCells(const Eigen::Vector3d& p_W) const {
    return (p_W - grid_.shape().origin_W) / grid_.shape().resolution_m;
  }

  const VoxelGrid& grid_;
  Obstacles obstacles_;
  int16_t free_;
  std::vector<Level> levels_;  ///< Over the cells, which are level 0; the last has one cube.
};

}  // namespace nbs
