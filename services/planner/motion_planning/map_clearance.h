#pragma once

#include <Eigen/Geometry>
#include <mutex>
#include <optional>

#include "common/mapping/distance_field.h"
#include "services/planner/motion_planning/clearance.h"
#include "services/planner/motion_planning/obstacle_pyramid.h"

namespace nbs {

/// Clearances in the probabilistic voxel space. Outside of it everything is free, so beyond the distance fields' reach
/// the distance to its box takes over. What is touched is decided by the cells.
///
/// Keeps a reference to the grid, which must stay as it was.
class MapClearance final : public Clearance {
 public:
  /// The fields have blocks of two cells, or of as many as they need to reach as far as ever in a finer grid.
  explicit MapClearance(const VoxelGrid& grid);
  explicit MapClearance(VoxelGrid&& grid) = delete;

  double CalcObstacleDistance(const Eigen::Vector3d& p_W) const override { return CalcDistance(to_occupied_, p_W); }
  double CalcUnknownDistance(const Eigen::Vector3d& p_W) const override { return CalcDistance(to_unknown_, p_W); }
  bool IsTouched(Obstacles obstacles, const Capsule& capsule_W) const override;
  bool IsTouched(Obstacles obstacles, const Block& block_W, double margin_m) const override;

 private:
  /// Made when it is first asked for, by whichever thread: a free-flying sensor never does.
  struct Cells {
    std::once_flag made;
    std::optional<ObstaclePyramid> pyramid;
  };
  const ObstaclePyramid& CellsOf(Obstacles obstacles) const;
  double CalcDistance(const DistanceField& field, const Eigen::Vector3d& p_W) const;

  Eigen::AlignedBox3d box_W_;
  DistanceField to_occupied_;
  DistanceField to_unknown_;
  const VoxelGrid& grid_;
  mutable Cells occupied_;
  mutable Cells unknown_;
};

}  // namespace nbs
