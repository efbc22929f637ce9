#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mapping/voxel_grid.h"

namespace nbs {

/// What counts as information.
enum class GainRule : uint8_t {
  kSum,          ///< The entropy of every cell (eq. 2 of the paper).
  kNearSurface,  ///< The entropy of cells near the surface that is known so far: where it must go on.
};

/// What a beam gains by passing through each cell of a voxel space, made once a round for all candidates.
///
/// Most of the entropy of a half-scanned space can never be gained: the inside of the object, and the air beside its
/// silhouette, where no beam returns and therefore nothing is freed. What can be gained lies where the known surface
/// goes on. kNearSurface counts only cells within `reach_m` of an occupied one (the proximity idea of Vasquez-Gomez et
/// al. and Delmerico et al., "A comparison of volumetric information gain metrics for active 3D object reconstruction",
/// Autonomous Robots 42, 2018, DOI 10.1007/s10514-017-9634-0); in a space without occupied cells it is kSum.
class GainMap {
 public:
  /// Value of an occupied cell: beams end before it.
  static constexpr uint16_t kWall = 0xffff;

  /// @param reach_m  Metres between the centres of two cells, >= 0; at most 60 cells.
  /// @throws std::invalid_argument if reach_m is out of range.
  explicit GainMap(const VoxelGrid& grid, GainRule rule = GainRule::kSum, double reach_m = 0.025);

  const GridShape& shape() const { return shape_; }
  /// By cell index: gain in 1/65536 nat, or kWall.
  std::span<const uint16_t> values() const { return values_; }

 private:
  GridShape shape_;
  std::vector<uint16_t> values_;
};

}  // namespace nbs
