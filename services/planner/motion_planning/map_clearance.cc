#include "services/planner/motion_planning/map_clearance.h"

namespace nbs {

MapClearance::MapClearance(const VoxelGrid& grid, const DistanceFieldSettings& settings)
    : to_occupied_(grid, Obstacles::kOccupied, settings), to_unknown_(grid, Obstacles::kOccupiedOrUnknown, settings) {}

}  // namespace nbs
