#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace nbs {

/// Unbounded sparse grid over W: maps each cubic cell to the head of a caller's list (an index, kNone when empty).
///
/// Cells live in bricks of 8 x 8 x 8, found by an open-addressing hash; a brick keeps one byte of occupancy for each
/// row along z, so that a search over a box skips empty space at a byte a row. A brick whose cells are all empty again
/// is used for another place. Cells are visited in the order brick (x,
/// y, z), then cell (x, y, z): never in an order of insertion.
class BrickGrid {
 public:
  static constexpr int32_t kNone = -1;
  /// Coordinates beyond this (metres, any axis) have no cell.
  static constexpr float kReach_m = 1000.0f;

  /// @param cell_m  Edge of a cell, metres.
  /// @throws std::invalid_argument if it is not at least 0.1 mm.
  explicit BrickGrid(float cell_m);

  /// Head of the list of the cell of p_W, for writing; makes the brick if there is none. A caller that sets kNone must
  /// use Clear instead.
  ///
  /// @param p_W  Finite, within kReach_m.
  int32_t& Touch(const Eigen::Vector3f& p_W);

  /// Head of the list of the cell of p_W; kNone if empty.
  int32_t Find(const Eigen::Vector3f& p_W) const;

  /// Empties the cell of p_W.
  void Clear(const Eigen::Vector3f& p_W);

  /// Calls visit(head) for each cell that is not empty and meets the cube of half edge radius_m about p_W.
  template <typename Visit>
  void ForEachCell(const Eigen::Vector3f& p_W, float radius_m, Visit&& visit) const;

 private:
  static constexpr int kShift = 3, kEdge = 1 << kShift, kMask = kEdge - 1;
  static constexpr unsigned kFullRow = (1u << kEdge) - 1;
  struct Brick {
    std::array<int32_t, kEdge * kEdge * kEdge> heads;
    std::array<uint8_t, kEdge * kEdge> rows;  // Bit z of row (x, y): the cell holds something.
    int filled;                               // Cells that do.
  };
  using Cell = Eigen::Vector3i;

  Cell CellOf(const Eigen::Vector3f& p_W) const {
    return {static_cast<int>(std::floor(p_W.x() * inverse_cell_)),
            static_cast<int>(std::floor(p_W.y() * inverse_cell_)),
            static_cast<int>(std::floor(p_W.z() * inverse_cell_))};
  }
  static uint64_t KeyOf(int x, int y, int z) {
    constexpr uint64_t kBits = (1u << 21) - 1;
    return (static_cast<uint64_t>(x) & kBits) << 42 | (static_cast<uint64_t>(y) & kBits) << 21 |
           (static_cast<uint64_t>(z) & kBits);
  }
  int32_t FindBrick(uint64_t key) const;
  int32_t InsertBrick(uint64_t key);
  void Grow();
  size_t SlotOf(uint64_t key) const;

  template <typename Visit>
  static void VisitBrick(const Brick& brick, const Cell& low, const Cell& high, Visit& visit);

  float inverse_cell_;
  size_t key_count_ = 0;
  std::vector<uint64_t> keys_;   // Hash table: key of the brick + 1; 0: free.
  std::vector<int32_t> values_;  // Beside it: number of the brick, or kNone.
  std::vector<std::unique_ptr<Brick>> bricks_;
  std::vector<int32_t> free_;  // Bricks without a place.
};

template <typename Visit>
void BrickGrid::VisitBrick(const Brick& brick, const Cell& low, const Cell& high, Visit& visit) {
  const unsigned span = (kFullRow << low.z()) & (kFullRow >> (kMask - high.z()));
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      unsigned row = brick.rows[kEdge * x + y] & span;
      while (row != 0) {
        const int z = __builtin_ctz(row);
        row &= row - 1;
        visit(brick.heads[kEdge * (kEdge * x + y) + z]);
      }
    }
  }
}

template <typename Visit>
void BrickGrid::ForEachCell(const Eigen::Vector3f& p_W, float radius_m, Visit&& visit) const {
  const Cell low = CellOf(p_W - Eigen::Vector3f::Constant(radius_m));
  const Cell high = CellOf(p_W + Eigen::Vector3f::Constant(radius_m));
  for (int x = low.x() >> kShift; x <= high.x() >> kShift; ++x) {
    for (int y = low.y() >> kShift; y <= high.y() >> kShift; ++y) {
      for (int z = low.z() >> kShift; z <= high.z() >> kShift; ++z) {
        const int32_t brick = FindBrick(KeyOf(x, y, z));
        if (brick == kNone) continue;
        const Cell origin(kEdge * x, kEdge * y, kEdge * z);
        VisitBrick(*bricks_[brick], (low - origin).cwiseMax(0), (high - origin).cwiseMin(kMask), visit);
      }
    }
  }
}

}  // namespace nbs
