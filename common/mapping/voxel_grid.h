#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mapping/voxel_delta.h"

namespace nbs {

/// Smallest log-odds of an occupied cell: p >= 0.95 (section III-C), ceil(1024 ln(0.95 / 0.05)).
inline constexpr int16_t kOccupiedLogOdds = 3016;

/// A cell is known to be free up to this p.
inline constexpr double kFreeProbability = 0.3;

/// Entropies are integers in 1/65536 nat, so that a sum of them does not depend on order or threads.
inline constexpr double kEntropyPerNat = 65536.0;

/// True if a cell with this log-odds is occupied. A cell that was never observed is not.
inline constexpr bool IsOccupied(int16_t log_odds) { return log_odds >= kOccupiedLogOdds; }

/// p = 1 / (1 + exp(-l)); 0.5 for kUnobserved.
double CalcProbability(int16_t log_odds);

/// The nearest log-odds of a probability in (0, 1), limited to the int16 range without kUnobserved.
///
/// @throws std::invalid_argument if p is not in (0, 1).
int16_t CalcLogOdds(double probability);

/// H(p) = -p ln p - (1 - p) ln(1 - p) of every log-odds (eq. 1) in 1/65536 nat, rounded to nearest; entry of l:
/// [static_cast<uint16_t>(l)]. At most that of kUnobserved and 0, ln 2.
std::span<const uint16_t, 65536> EntropyTable();

/// The probabilistic voxel space (section III-C): one int16 log-odds per cell of a box, dense. What lies outside is
/// known to be free.
class VoxelGrid {
 public:
  /// A grid of cells that were never observed.
  ///
  /// @throws ConfigError if the resolution or the origin is not finite or the resolution not positive, a side has less
  /// than one cell, the origin is no multiple
  ///         of the resolution (to 1e-6 cells), or there are more than kMaxGridCells cells.
  explicit VoxelGrid(const GridShape& shape);

  const GridShape& shape() const { return shape_; }
  /// All cells in index order (GridShape::Index).
  std::span<const int16_t> cells() const { return cells_; }
  std::span<int16_t> cells() { return cells_; }
  int16_t At(int x, int y, int z) const { return cells_[shape_.Index(x, y, z)]; }

  /// Folds the changes of another grid of the same shape in: afterwards the cells of the runs hold the delta's values.
  ///
  /// @throws std::invalid_argument if the runs do not ascend, overlap, leave the grid or disagree with the number of
  /// values; the grid is then unchanged.
  void Apply(const VoxelDelta& delta);

  bool operator==(const VoxelGrid&) const = default;

 private:
  GridShape shape_;
  std::vector<int16_t> cells_;
};

/// Remembers which cells of a grid changed, in time proportional to the changes.
class ChangeTracker {
 public:
  explicit ChangeTracker(int64_t cells) : words_((cells + 63) / 64, 0) {}

  /// Notes that a cell changed; noting it again has no effect.
  void Mark(int64_t index) {
    uint64_t& word = words_[index >> 6];
    if (word == 0) marked_words_.push_back(static_cast<uint32_t>(index >> 6));
    word |= uint64_t{1} << (index & 63);
  }

  /// The same for many cells.
  void MarkAll(std::span<const uint32_t> indices) {
    size_t marked = marked_words_.size();
    marked_words_.resize(marked + indices.size());
    for (const uint32_t index : indices) {
      uint64_t& word = words_[index >> 6];
      marked_words_[marked] = index >> 6;
      marked += word == 0 ? 1 : 0;
      word |= uint64_t{1} << (index & 63);
    }
    marked_words_.resize(marked);
  }

  /// The runs of marked cells with their values in `grid`, ascending; a run of more than 65,535 cells comes in pieces.
  /// Forgets the marks. Time, scan and end_of_scan are left at their defaults.
  VoxelDelta TakeDelta(const VoxelGrid& grid);

 private:
  std::vector<uint64_t> words_;         ///< One bit per cell.
  std::vector<uint32_t> marked_words_;  ///< Words that are not 0, each once.
};

}  // namespace nbs
