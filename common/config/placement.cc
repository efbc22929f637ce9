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

/// The path that looks along `view_W` and runs along `along_W`, over the box's whole extent but for what is too near to
/// the table.
///
/// @param share  Of the extent that is left.
ScanPath MakeFirstPath(const GridShape& grid, const CellConfig& cell, const Eigen::Vector3d& view_W,
                       const Eigen::Vector3d& along_W, double& share) {
  const Eigen::Vector3d half_sizes = 0.5 * grid.resolution_m * grid.size.cast<double>();
  const Eigen::Vector3d center_W = grid.origin_W + half_sizes;
  const Eigen::Vector3d middle_W = center_W - view_W * (CalcHalfExtent(half_sizes, view_W) + cell.first_standoff_m);
  const Eigen::Vector3d reach_W = along_W * CalcHalfExtent(half_sizes, along_W);
  ScanPath path;
  path.X_WS_start = MakeLookPose(middle_W - reach_W, view_W, along_W);
  path.X_WS_end = MakeLookPose(middle_W + reach_W, view_W, along_W);
  Raise(cell, along_W, path.X_WS_start);
  Raise(cell, along_W, path.X_WS_end);
  const Eigen::Vector3d left_W = path.X_WS_end.translation() - path.X_WS_start.translation();
  share = left_W.dot(reach_W) / (2.0 * reach_W.squaredNorm());
  return path;
}

/// Where an object is so low that most of a path beside it would be too near to the table, the sensor looks down at it.
ScanPath PlaceFirstPath(const GridShape& grid, const CellConfig& cell) {
  constexpr double kLeastShare = 0.7;
  constexpr int kSteps = 16;
  constexpr double kStep_rad = 0.08726646259971647;  // 5 degrees
  const Eigen::Vector3d view_W = cell.first_view_W.normalized(), along_W = cell.first_along_W.normalized();
  double share = 0.0;
  const ScanPath level = MakeFirstPath(grid, cell, view_W, along_W, share);
  const Eigen::Vector3d aside_W = view_W.cross(Eigen::Vector3d::UnitZ());
  if (share >= kLeastShare || aside_W.norm() < kTolerance) return level;
  for (int step = 1; step <= kSteps; ++step) {
    const Eigen::AngleAxisd down(-step * kStep_rad, aside_W.normalized());
    const ScanPath path = MakeFirstPath(grid, cell, down * view_W, down * along_W, share);
    if (share >= kLeastShare) return path;
  }
  return level;
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
