#pragma once

#include <cmath>
#include <cstdint>

#include "common/mapping/voxel_delta.h"

namespace nbs {

/// A straight segment made ready to be walked cell by cell.
///
/// Its length is 2^30 ticks; t_max is the tick at which the walk next leaves its cell along an axis, t_delta the ticks
/// between two such crossings. An axis that is stepped along n times has its first n crossings at or before tick 2^30
/// and the next one behind it, whatever the rounding did: so the walk makes exactly |dx| + |dy| + |dz| steps and ends
/// in the end's cell.
struct RayWalk {
  int64_t index = 0;       ///< Cell in which the walk begins.
  int32_t steps = -1;      ///< Steps to the last cell; -1: the segment does not touch the box, nothing to walk.
  uint32_t t_max[3] = {};  ///< Ticks.
  uint32_t t_delta[3] = {};
  int64_t stride[3] = {};  ///< What a step along each axis adds to the index.
};

/// Readies the segment from A to B, clipped to the box of the grid.
///
/// A cell holds its lower faces, not its upper ones (as OctoMap's keys do); a clipped end on the box's upper face
/// belongs to the last cell. Ends that are not finite or more than 1e9 cells away give a walk of nothing.
///
/// @param p_WA, p_WB  Metres; may be equal.
RayWalk MakeRayWalk(const GridShape& shape, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB);

/// Tells points' cells, many in one grid.
class CellFinder {
 public:
  explicit CellFinder(const GridShape& shape);

  /// Index of the cell that holds a point; -1 outside the box, or if the point is not finite.
  int64_t Find(const Eigen::Vector3d& p_W) const {
    int64_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double cell = std::floor(p_W[axis] * cells_per_m_) - low_[axis];
      if (!(cell >= 0.0 && cell < size_[axis])) return -1;
      index = index * size_[axis] + static_cast<int64_t>(cell);
    }
    return index;
  }

 private:
  double cells_per_m_;
  Eigen::Vector3d low_;  ///< The grid's lowest corner, cells from W's origin.
  Eigen::Vector3i size_;
};

/// The same for one point.
int64_t FindCell(const GridShape& shape, const Eigen::Vector3d& p_W);

/// Calls `visit(index)` for the cells that the segment passes through, from the cell of A to that of B, until it
/// returns false.
///
/// Neighbours share a face and no cell comes twice. After Amanatides & Woo, Eurographics 1987, in integers: equal input
/// gives equal cells on every machine, and a segment may be walked by any thread. Where it meets an edge or a corner
/// exactly it steps along z before y before x, as OctoMap's computeRayKeys does, whose cells it visits but for
/// crossings that lie within the rounding of a tick.
template <typename Visit>
inline void WalkRay(const RayWalk& ray, Visit&& visit) {
  if (ray.steps < 0) return;
  int64_t index = ray.index;
  if (!visit(index)) return;
  const int64_t step_x = ray.stride[0], step_y = ray.stride[1], step_z = ray.stride[2];
  const uint32_t delta_x = ray.t_delta[0], delta_y = ray.t_delta[1], delta_z = ray.t_delta[2];
  uint32_t t_x = ray.t_max[0], t_y = ray.t_max[1], t_z = ray.t_max[2];
  for (int32_t left = ray.steps; left > 0; --left) {
    if (t_x < t_y) {
      if (t_x < t_z) {
        index += step_x;
        t_x += delta_x;
      } else {
        index += step_z;
        t_z += delta_z;
      }
    } else if (t_y < t_z) {
      index += step_y;
      t_y += delta_y;
    } else {
      index += step_z;
      t_z += delta_z;
    }
    if (!visit(index)) return;
  }
}

}  // namespace nbs
