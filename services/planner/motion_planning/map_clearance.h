#pragma once

#include "common/mapping/distance_field.h"
#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// Clearances in the probabilistic voxel space, as it is when the object is made; outside of it everything is free.
class MapClearance final : public Clearance {
 public:
  explicit MapClearance(const VoxelGrid& grid, const DistanceFieldSettings& settings = {});

  double CalcObstacleDistance(const Eigen::Vector3d& p_W) const override { return to_occupied_.CalcDistance(p_W); }
  double CalcUnknownDistance(const Eigen::Vector3d& p_W) const override { return to_unknown_.CalcDistance(p_W); }

 private:
  DistanceField to_occupied_;
  DistanceField to_unknown_;
};

}  // namespace nbs
