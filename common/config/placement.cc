#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "common/config/run_config.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

// A box that ends on a voxel's face to within this share of a voxel does not get one more layer.
constexpr double kTolerance = 1e-6;

GridShape PlaceGrid(const Eigen::AlignedBox3d& box_W, double resolution_m) {
  GridShape grid;
  grid.resolution_m = resolution_m;
  double cells = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = std::floor(box_W.min()[axis] / resolution_m + kTolerance);
    const double last = std::ceil(box_W.max()[axis] / resolution_m - kTolerance);
    const double count = std::max(1.0, last - first);
    cells *= count;
    if (!(cells <= static_cast<double>(kMaxGridCells))) {
      throw ConfigError(
          fmt::format("the box around the object would take more than {} voxels of {} m: is the object's "
                      "unit metres, or should the cell's `resolution_m` be larger?",
                      kMaxGridCells, resolution_m));
    }
    grid.origin_W[axis] = first * resolution_m;
    grid.size[axis] = static_cast<int>(count);
  }
  return grid;
}

/// Half of the box's extent along a unit vector.
double CalcHalfExtent(const Eigen::Vector3d& half_sizes, const Eigen::Vector3d& direction) {
  return direction.cwiseAbs().dot(half_sizes);
}

/// Moves an end of the first path along it until it is high enough above the table.
void Raise(const CellConfig& cell, const Eigen::Vector3d& along_W, Pose& X_WS) {
  if (!cell.table_z_m || std::abs(along_W.z()) < kTolerance) return;
  const double missing = *cell.table_z_m + cell.first_above_table_m - X_WS.translation().z();
  if (missing > 0.0) X_WS.translation() += missing / along_W.z() * along_W;
}

ScanPath PlaceFirstPath(const GridShape& grid, const CellConfig& cell) {
  const Eigen::Vector3d half_sizes = 0.5 * grid.resolution_m * grid.size.cast<double>();
  const Eigen::Vector3d center_W = grid.origin_W + half_sizes;
  const Eigen::Vector3d view_W = cell.first_view_W.normalized();
  const Eigen::Vector3d along_W = cell.first_along_W.normalized();
  const Eigen::Vector3d middle_W = center_W - view_W * (CalcHalfExtent(half_sizes, view_W) + cell.first_standoff_m);
  const Eigen::Vector3d reach_W = along_W * CalcHalfExtent(half_sizes, along_W);
  ScanPath path;
  path.X_WS_start = MakeLookPose(middle_W - reach_W, view_W, along_W);
  path.X_WS_end = MakeLookPose(middle_W + reach_W, view_W, along_W);
  Raise(cell, along_W, path.X_WS_start);
  Raise(cell, along_W, path.X_WS_end);
  return path;
}

}  // namespace

void ResolvePlacement(const Eigen::AlignedBox3d& object_box_W, RunConfig& config) {
  if (object_box_W.isEmpty() || !object_box_W.min().allFinite() || !object_box_W.max().allFinite()) {
    throw ConfigError("the object's bounding box is empty or not finite");
  }
  config.p_WO = object_box_W.center();
  config.p_WO.z() = object_box_W.min().z();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(config.cell.unknown_margin_m);
  Eigen::AlignedBox3d box_W(object_box_W.min() - margin, object_box_W.max() + margin);
  if (config.cell.table_above_object_m) {
    config.cell.table_z_m = config.p_WO.z() + *config.cell.table_above_object_m;
    box_W.min().z() = std::max(box_W.min().z(), *config.cell.table_z_m);
  }
  config.grid = PlaceGrid(box_W, config.cell.resolution_m);
  config.first_path = PlaceFirstPath(config.grid, config.cell);
}

Pose CalcBasePose(const RunConfig& config) { return Eigen::Translation3d(config.p_WO) * config.cell.arm.value().X_OB; }

}  // namespace nbs
