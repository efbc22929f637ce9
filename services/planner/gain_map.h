#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mapping/ray_bundle.h"
#include "common/mapping/voxel_grid.h"
#include "common/planning/gain_rule.h"

namespace nbs {

/// What a beam gains by passing through each cell of a voxel space, made once a round for all candidates.
///
/// Most of the entropy of a half-scanned space can never be gained: the inside of the object, and the air beside its
/// silhouette, where no beam returns and therefore nothing is freed. What can be gained lies where the known surface
/// goes on. kNearSurface counts only cells within `reach_m` of an occupied one (the proximity idea of Vasquez-Gomez et
/// al. and Delmerico et al., "A comparison of volumetric information gain metrics for active 3D object reconstruction",
/// Autonomous Robots 42, 2018, DOI 10.1007/s10514-017-9634-0); in a space without occupied cells it is kSum.
///
/// kMean and kPerSecond weigh the gain of kSum, so their map is the same. For kUnknownCount a cell is free up to p =
/// kFreeProbability, occupied from 0.95, and unknown between.
class GainMap {
 public:
  /// Value of an occupied cell: beams end before it.
  static constexpr uint16_t kWall = RayBundle::kWall;
  /// Value of an unknown cell under kUnknownCount: beams end in it and gain 1. Above every entropy.
  static constexpr uint16_t kGoal = RayBundle::kGoal;

  /// @param reach_m  Metres between the centres of two cells, >= 0; at most 60 cells.
  /// @throws std::invalid_argument if reach_m is out of range.
  explicit GainMap(const VoxelGrid& grid, GainRule rule = GainRule::kSum, double reach_m = 0.025);

  const GridShape& shape() const { return shape_; }
  /// By cell index: gain in unit() / 65536 nat, kWall or kGoal.
  /// One more entry lies behind the last cell, for RayBundle::Sum.
  std::span<const uint16_t> values() const { return std::span(values_).first(values_.size() - 1); }
  /// By what a sum over values must be multiplied: ln 2 (65536 times) for kUnknownCount, else 1.
  int64_t unit() const { return unit_; }

 private:
  GridShape shape_;
  int64_t unit_ = 1;
  std::vector<uint16_t> values_;
};

}  // namespace nbs
