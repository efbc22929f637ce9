#include "common/mapping/ray_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace nbs {
namespace {

constexpr int64_t kRayTicks = int64_t{1} << 30;
/// A crossing interval longer than the ray is never used up: anything above its length keeps t_max within 32 bits.
constexpr double kMaxDeltaTicks = 1.0 * kRayTicks + 1.0;

/// Further out, doubles begin to lose the fine part of a cell coordinate.
constexpr double kMaxCells = 1e9;

Eigen::Vector3d ToCells(const GridShape& shape, const Eigen::Vector3d& p_W) { return p_W * (1.0 / shape.resolution_m); }

Eigen::Vector3d OriginInCells(const GridShape& shape) { return ToCells(shape, shape.origin_W).array().round(); }

/// Cuts the segment a + t (b - a), t in [0, 1], to the box from `low` to `high`; false if nothing is left.
bool Clip(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
          double& t_in, double& t_out) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a[axis] >= low[axis] && a[axis] < high[axis] && b[axis] >= low[axis] && b[axis] < high[axis]) continue;
    const double d = b[axis] - a[axis];
    if (d == 0.0) return false;
    double t_lower = (low[axis] - a[axis]) / d;
    double t_upper = (high[axis] - a[axis]) / d;
    if (t_lower > t_upper) std::swap(t_lower, t_upper);
    t_in = std::max(t_in, t_lower);
    t_out = std::min(t_out, t_upper);
  }
  return t_in < t_out;
}

/// First crossing and interval of one axis that is stepped along `count` times, in ticks.
void CalcTicks(double a, double d, int cell, int count, uint32_t& t_max, uint32_t& t_delta) {
  t_max = std::numeric_limits<uint32_t>::max();
  t_delta = 0;
  if (count == 0) return;
  const double per_cell = kRayTicks / std::abs(d);
  const double to_face = d > 0.0 ? cell + 1 - a : a - cell;
  // count - 1 intervals never exceed the ray, so the limits below are in order and `highest` is not negative.
  int64_t delta = static_cast<int64_t>(std::min(per_cell, kMaxDeltaTicks));
  if (count > 1) delta = std::min(delta, kRayTicks / (count - 1));
  const int64_t lowest = std::max<int64_t>(0, kRayTicks + 1 - count * delta);
  const int64_t highest = kRayTicks - (count - 1) * delta;
  const double first = std::clamp(to_face * per_cell, 0.0, 1.0 * kRayTicks);
  t_max = static_cast<uint32_t>(std::clamp(static_cast<int64_t>(first + 0.5), lowest, highest));
  t_delta = static_cast<uint32_t>(delta);
}

}  // namespace

RayWalk MakeRayWalk(const GridShape& shape, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) {
  RayWalk ray;
  // In cells from W's origin, so that a point falls into the same cell whatever the box.
  Eigen::Vector3d a = ToCells(shape, p_WA);
  Eigen::Vector3d b = ToCells(shape, p_WB);
  if (!(a.array().abs() < kMaxCells).all() || !(b.array().abs() < kMaxCells).all()) return ray;
  const Eigen::Vector3d low = OriginInCells(shape);
  double t_in = 0.0, t_out = 1.0;
  if (!Clip(a, b, low, low + shape.size.cast<double>(), t_in, t_out)) return ray;
  const Eigen::Vector3d along = b - a;
  if (t_out < 1.0) b = a + t_out * along;
  if (t_in > 0.0) a += t_in * along;

  const int64_t stride[3] = {1, shape.size.x(), static_cast<int64_t>(shape.size.x()) * shape.size.y()};
  ray.steps = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = shape.size[axis] - 1;
    const int cell_a = static_cast<int>(std::clamp(std::floor(a[axis]) - low[axis], 0.0, last));
    const int cell_b = static_cast<int>(std::clamp(std::floor(b[axis]) - low[axis], 0.0, last));
    const int count = std::abs(cell_b - cell_a);
    CalcTicks(a[axis] - low[axis], b[axis] - a[axis], cell_a, count, ray.t_max[axis], ray.t_delta[axis]);
    ray.stride[axis] = cell_b < cell_a ? -stride[axis] : stride[axis];
    ray.index += cell_a * stride[axis];
    ray.steps += count;
  }
  return ray;
}

CellFinder::CellFinder(const GridShape& shape)
    : cells_per_m_(1.0 / shape.resolution_m), low_(OriginInCells(shape)), size_(shape.size) {}

int64_t FindCell(const GridShape& shape, const Eigen::Vector3d& p_W) { return CellFinder(shape).Find(p_W); }

}  // namespace nbs
