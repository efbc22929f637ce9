#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace nbs {

/// Where a dense voxel grid lies: an axis-aligned box in W, cut into cubes.
struct GridShape {
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  ///< Lowest corner, metres; a multiple of the resolution on each
                                                       ///< axis, as OctoMap's keys want.
  double resolution_m = 0.005;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();  ///< Cells along x, y, z.

  int64_t cells() const { return static_cast<int64_t>(size.x()) * size.y() * size.z(); }
  /// x runs fastest, then y, then z.
  int64_t Index(int x, int y, int z) const { return (static_cast<int64_t>(z) * size.y() + y) * size.x() + x; }
  bool operator==(const GridShape&) const = default;
};

/// Largest grid, cells: 512 cubed, 256 MiB of log-odds.
inline constexpr int64_t kMaxGridCells = int64_t{512} * 512 * 512;

/// Log-odds are kept in 1/1024 nat; this code means "never observed" (p = 0.5), apart from a known log-odds of 0.
inline constexpr int16_t kUnobserved = -32768;
inline constexpr double kLogOddsPerNat = 1024.0;

/// What changed in the voxel space since the delta before it: runs of cells that follow each other in index order, with
/// their new values.
struct VoxelDelta {
  int64_t utime_us = 0;  ///< Time of the last stripe folded in.
  int32_t scan = 0;
  bool end_of_scan = false;          ///< True on the last delta of a scan.
  std::vector<uint32_t> run_start;   ///< Cell index of each run's first cell, ascending.
  std::vector<uint16_t> run_length;  ///< Cells in each run, >= 1.
  std::vector<int16_t> values;       ///< New log-odds of all runs, one after the other.

  bool operator==(const VoxelDelta&) const = default;
};

}  // namespace nbs
