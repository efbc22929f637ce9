#pragma once

#include <octomap/OcTree.h>

#include <cstdint>
#include <span>

#include "common/mapping/voxel_grid.h"
#include "services/planner/information_gain.h"
#include "tests/bench/voxels_workload.h"
#include "tests/services/voxelmap/tree_of_our_model.h"

/// OctoMap doing the working map's tasks as well as it can: the peer of the benchmarks.
namespace nbs::bench {

/// Of this thread.
double CpuSeconds();

/// OctoMap's best way: one cloud per stripe, lazily, inner nodes brought up to date once at the end. Returns CPU
/// seconds.
double InsertByOctomap(const MappingWorkload& workload, octomap::OcTree& tree);

/// Cells of the grid that were observed, and those where the tree says something else.
struct Comparison {
  int64_t observed = 0;
  int64_t different = 0;           ///< Another log-odds.
  int64_t different_in_class = 0;  ///< Occupied in one of the two only, or never observed in one of the two only.
};

Comparison Compare(const VoxelGrid& grid, const octomap::OcTree& tree);

/// A tree with the observed cells of the grid.
octomap::OcTree MakeTree(const VoxelGrid& grid);

/// Brings such a tree, of a grid of the given shape, up to date with changed cells.
void Apply(const VoxelDelta& delta, const GridShape& shape, octomap::OcTree& tree);

/// Eq. 2 on OctoMap in one pass: computeRayKeys, search, entropies from the same table.
class GainByOctomap {
 public:
  GainByOctomap(const octomap::OcTree& tree, const GridShape& shape, const Profiler& profiler);

  /// As InformationGain::Calc of a map of GainRule::kSum.
  int64_t Calc(const ScanPath& path, GainSampling sampling, int threads = 1) const;

  /// As InformationGain::CalcAll.
  std::vector<int64_t> CalcAll(std::span<const ScanPath> paths, GainSampling sampling, int threads) const;

 private:
  /// Sum over the sampled beams of the stripes that come to one of `threads` threads.
  int64_t SumPart(const ScanPath& path, GainSampling sampling, int threads, int thread) const;
  int64_t CalcRay(const octomap::point3d& a, const octomap::point3d& b, octomap::KeyRay& ray) const;

  const octomap::OcTree& tree_;
  Eigen::Vector3i first_, last_;  ///< Keys of the grid's first cell and of the one behind its last.
  Profiler profiler_;
  InformationGain count_;  ///< For its number of stripes.
  std::vector<Eigen::Vector3d> directions_S_;
};

}  // namespace nbs::bench
