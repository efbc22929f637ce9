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
      to_unknown_(grid, Obstacles::kOccupiedOrUnknown, MakeFieldSettings(grid.shape().resolution_m)),
      grid_(grid) {}

const ObstaclePyramid& MapClearance::CellsOf(Obstacles obstacles) const {
  Cells& cells = obstacles == Obstacles::kOccupied ? occupied_ : unknown_;
  std::call_once(cells.made, [&] { cells.pyramid.emplace(grid_, obstacles, kFreeProbability); });
  return *cells.pyramid;
}

double MapClearance::CalcDistance(const DistanceField& field, const Eigen::Vector3d& p_W) const {
  const double to_box = box_W_.exteriorDistance(p_W);
  return to_box >= field.max_distance_m() ? to_box : std::max(to_box, field.CalcDistance(p_W));
}

bool MapClearance::IsTouched(Obstacles obstacles, const Capsule& capsule_W) const {
  const Eigen::Vector3d middle_W = 0.5 * (capsule_W.p_A + capsule_W.p_B);
  const double around_m = capsule_W.radius_m + 0.5 * (capsule_W.p_B - capsule_W.p_A).norm();
  return Clearance::CalcDistance(obstacles, middle_W) < around_m && CellsOf(obstacles).IsTouched(capsule_W);
}

bool MapClearance::IsTouched(Obstacles obstacles, const Block& block_W, double margin_m) const {
  const double around_m = margin_m + block_W.half.norm();
  return Clearance::CalcDistance(obstacles, block_W.X_LC.translation()) < around_m &&
         CellsOf(obstacles).IsTouched(block_W, margin_m);
}

}  // namespace nbs
