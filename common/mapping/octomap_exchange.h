#pragma once

#include <filesystem>

#include "common/mapping/voxel_grid.h"

namespace nbs {

/// Writes the grid as an OctoMap tree (.ot, for octovis and every other user of OctoMap): an OcTree of the grid's
/// resolution whose search finds, at each observed cell, its log-odds in nats; cells never observed are not in the
/// tree. Equal neighbours are pruned to coarser leaves.
///
/// The file holds no occupancy threshold: ours is p >= 0.95, OctoMap's reader wants setOccupancyThres(0.95).
/// Written to a temporary file beside it and renamed, so that a half-written file never stands there.
///
/// @throws std::runtime_error if the file cannot be written; std::invalid_argument if the grid reaches outside of
/// OctoMap's 2^16 cells per axis.
void WriteOctomap(const VoxelGrid& grid, const std::filesystem::path& file);

/// Reads such a file into a grid of the given shape. Reading what was written gives an equal grid.
///
/// @throws ConfigError if the file is missing, no OcTree, cut short, of another resolution, or holds cells outside the
/// shape or log-odds beyond 31 nats.
VoxelGrid ReadOctomap(const std::filesystem::path& file, const GridShape& shape);

}  // namespace nbs
