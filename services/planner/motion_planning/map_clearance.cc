#include "services/planner/motion_planning/map_clearance.h"

#include <algorithm>

namespace nbs {

MapClearance::MapClearance(const VoxelGrid& grid, const DistanceFieldSettings& settings)
    : box_W_(grid.shape().origin_W,
             grid.shape().origin_W + grid.shape().resolution_m * grid.shape().size.cast<double>()),
      to_occupied_(grid, Obstacles::kOccupied, settings),
      to_unknown_(grid, Obstacles::kOccupiedOrUnknown, settings) {}

double MapClearance::CalcDistance(const DistanceField& field, const Eigen::Vector3d& p_W) const {
  const double to_box = box_W_.exteriorDistance(p_W);
  return to_box >= field.max_distance_m() ? to_box : std::max(to_box, field.CalcDistance(p_W));
}

}  // namespace nbs
