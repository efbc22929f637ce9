#include "services/planner/motion_planning/map_clearance.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

DistanceFieldSettings MakeFieldSettings(double resolution_m) {
  DistanceFieldSettings settings;
  const double needed = settings.max_distance_m / (DistanceField::kMaxReach_blocks * resolution_m);
  settings.cells_per_block = std::max(settings.cells_per_block, static_cast<int>(std::ceil(needed - 1e-9)));
  return settings;
}

}  // namespace

MapClearance::MapClearance(const VoxelGrid& grid)
    : box_W_(grid.shape().origin_W,
             grid.shape().origin_W + grid.shape().resolution_m * grid.shape().size.cast<double>()),
      to_occupied_(grid, Obstacles::kOccupied, MakeFieldSettings(grid.shape().resolution_m)),
      to_unknown_(grid, Obstacles::kOccupiedOrUnknown, MakeFieldSettings(grid.shape().resolution_m)) {}

double MapClearance::CalcDistance(const DistanceField& field, const Eigen::Vector3d& p_W) const {
  const double to_box = box_W_.exteriorDistance(p_W);
  return to_box >= field.max_distance_m() ? to_box : std::max(to_box, field.CalcDistance(p_W));
}

}  // namespace nbs
