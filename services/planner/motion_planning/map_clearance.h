#pragma once

#include <Eigen/Geometry>

#include "common/mapping/distance_field.h"
#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// Clearances in the probabilistic voxel space, as it is when the object is made. Outside of it everything is free, so
/// beyond the distance fields' reach the distance to its box takes over.
class MapClearance final : public Clearance {
 public:
  /// The fields have blocks of two cells, or of as many as they need to reach as far as ever in a finer grid.
  explicit MapClearance(const VoxelGrid& grid);

  double CalcObstacleDistance(const Eigen::Vector3d& p_W) const override { return CalcDistance(to_occupied_, p_W); }
  double CalcUnknownDistance(const Eigen::Vector3d& p_W) const override { return CalcDistance(to_unknown_, p_W); }

 private:
  double CalcDistance(const DistanceField& field, const Eigen::Vector3d& p_W) const;

  Eigen::AlignedBox3d box_W_;
  DistanceField to_occupied_;
  DistanceField to_unknown_;
};

}  // namespace nbs
