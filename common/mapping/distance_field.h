#pragma once

#include <cstdint>
#include <vector>

#include "common/mapping/voxel_grid.h"

namespace nbs {

/// Which cells a body must stay clear of.
enum class Obstacles : uint8_t {
  kOccupied,           ///< p >= 0.95.
  kOccupiedOrUnknown,  ///< Everything that is not known to be free, cells never observed among them.
};

struct DistanceFieldSettings {
  int cells_per_block = 2;      ///< Edge of a block of the field, cells; a block with one obstacle cell is an obstacle.
  double max_distance_m = 0.3;  ///< Larger distances are reported as this.
  double free_max_probability = kFreeProbability;
};

/// Distances to the nearest obstacle of a voxel grid: an exact Euclidean distance transform over blocks of cells, cut
/// off at the largest distance.
///
/// Everything outside the grid is free. After Felzenszwalb & Huttenlocher, "Distance transforms of sampled functions",
/// Theory of Computing 8, 2012, DOI 10.4086/toc.2012.v008a019 (the transform separates by axis).
class DistanceField {
 public:
  static constexpr double kMaxReach_blocks = 60.0;

  /// @throws std::invalid_argument if a setting is out of range: cells_per_block in [1, 16], max_distance_m positive
  /// and at most kMaxReach_blocks, probability in (0, 0.95).
  DistanceField(const VoxelGrid& grid, Obstacles obstacles, const DistanceFieldSettings& settings = {});

  /// Distance in metres from a point to the nearest obstacle, in [0, max_distance_m]; never larger than the true one,
  /// and less than 2.5 block edges below it.
  ///
  /// Interpolated between the centres of the eight blocks around the point, as a bound from below: d^2(p) >=
  /// interpolation of d^2 - sum over the axes of f (1 - f) block^2, f the fraction of the way between two centres.
  double CalcDistance(const Eigen::Vector3d& p_W) const;

  double max_distance_m() const { return max_distance_m_; }

 private:
  double max_distance_m_ = 0.0;
  double block_m_ = 0.0;
  Eigen::Vector3d origin_W_ =
      Eigen::Vector3d::Zero();  ///< Centre of the field's first block, which lies a margin outside of the grid.
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();  ///< Blocks of the field, margins included.
  /// Per block the square of the distance between its centre and the surface of the nearest obstacle block, in half
  /// block edges; cut off beyond max_distance_m.
  std::vector<uint16_t> squares_;
};

}  // namespace nbs
