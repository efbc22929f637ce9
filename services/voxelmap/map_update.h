#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mapping/ray_bundle.h"
#include "common/mapping/ray_walk.h"
#include "common/mapping/voxel_grid.h"
#include "common/sensing/profiler.h"
#include "services/voxelmap/inverse_sensor_model.h"

namespace nbs {

/// The probabilistic voxel space and Bayes' update of it, stripe by stripe (section III-C): l <- l + log(p(z|occupied)
/// / p(z|free)), clamped.
///
/// One stripe is one observation of each cell that it touches: a hit if any return lies in the cell, else a pass if any
/// clear line crosses it. So neither the order of the beams nor their number in a cell matters, and a hit wins over the
/// passes of the same stripe.
///
/// Oblique beams cross cells of a surface without meeting it. So that they don't eat it, an occupied cell takes passes
/// more slowly: none in a scan that hit it, else one per scan. A single hit makes any cell occupied; two scans that
/// pass through it and never hit it clear it again.
class MapUpdate {
 public:
  /// @throws ConfigError for bad settings (MakeLogOddsSteps) or a bad shape (VoxelGrid).
  MapUpdate(const GridShape& shape, const Profiler& profiler, const InverseSensorModelSettings& settings = {},
            LaneSet lanes = FindWidestLanes());

  /// Folds a stripe in. Cells outside the grid are left alone.
  ///
  /// @pre  The stripe's ranges are finite, as many as the profiler has beams or none, and its pose is rigid.
  void Insert(const Stripe& stripe);

  const VoxelGrid& grid() const { return grid_; }

  /// What changed since the last call.
  VoxelDelta TakeDelta() { return changes_.TakeDelta(grid_); }

 private:
  void BeginStripe();
  void ApplyHit(uint32_t index, uint16_t scan);
  /// Keeps the cells that no other beam of the stripe has touched.
  std::span<uint32_t> TakeFresh(std::span<uint32_t> cells);
  /// One pass of each; uses the list up.
  void ApplyPasses(std::span<uint32_t> fresh, uint16_t scan);
  /// Whether an occupied cell takes a pass, which it then has.
  bool TakesPass(uint32_t index, uint16_t scan);

  Profiler profiler_;
  InverseSensorModelSettings settings_;
  LogOddsSteps steps_;
  std::vector<Eigen::Vector3d> directions_S_;
  VoxelGrid grid_;
  StripeEvidence evidence_;  ///< Of the last stripe; kept for its memory.
  CellFinder finder_;
  RayBundle rays_;
  ChangeTracker changes_;
  std::vector<uint64_t> touched_words_;  ///< One bit per cell: whether the stripe touched it.
  std::vector<uint32_t> touched_;        ///< These cells.
  std::vector<uint16_t> judged_;  ///< Scan + 1 (its low 16 bits) that last hit the cell, or passed through it while it
                                  ///< was occupied; 0: none.
};

}  // namespace nbs
