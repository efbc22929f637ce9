#include "common/mapping/distance_field.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

/// Above every square within reach, and far enough below 65,536 that a square may be added to it.
constexpr uint16_t kFar = 30000;

/// A box of squares, x fastest.
struct Field {
  Eigen::Vector3i size;
  std::vector<uint16_t> squares;

  explicit Field(const Eigen::Vector3i& s) : size(s), squares(static_cast<size_t>(s.x()) * s.y() * s.z(), kFar) {}
  uint16_t* Row(int y, int z) { return squares.data() + (static_cast<size_t>(z) * size.y() + y) * size.x(); }
  const uint16_t* Row(int y, int z) const { return const_cast<Field*>(this)->Row(y, z); }
};

/// Square of twice the distance from a block's centre to the surface of the block k further on, in block edges.
uint16_t CalcSquare(int k) {
  const int twice = std::max(2 * std::abs(k) - 1, 0);
  return static_cast<uint16_t>(twice * twice);
}

/// A cell is an obstacle if its log-odds, moved by `offset` modulo 2^16, is above `limit`: so one comparison tells, and
/// the highest of several cells tells for all of them.
struct ObstacleRule {
  uint16_t offset = 0;
  uint16_t limit = 0;

  uint16_t Rank(int16_t log_odds) const { return static_cast<uint16_t>(log_odds + offset); }
};

ObstacleRule MakeRule(Obstacles obstacles, int16_t free_log_odds) {
  // Never observed ranks lowest in the first case, highest in the second.
  if (obstacles == Obstacles::kOccupied) return {32768, static_cast<uint16_t>(kOccupiedLogOdds - 1 + 32768)};
  return {32767, static_cast<uint16_t>(free_log_odds + 32767)};
}

/// Marks the blocks of one row that hold an obstacle; true if any does.
///
/// @param ranks  Room for a row of cells.
bool MarkObstacles(const VoxelGrid& grid, const ObstacleRule& rule, int block, int by, int bz,
                   std::vector<uint16_t>& ranks, std::vector<uint8_t>& marks) {
  const Eigen::Vector3i& size = grid.shape().size;
  std::ranges::fill(ranks, uint16_t{0});
  for (int z = bz * block; z < std::min(size.z(), (bz + 1) * block); ++z) {
    for (int y = by * block; y < std::min(size.y(), (by + 1) * block); ++y) {
      const int16_t* cells = grid.cells().data() + grid.shape().Index(0, y, z);
      for (int x = 0; x < size.x(); ++x) ranks[x] = std::max(ranks[x], rule.Rank(cells[x]));
    }
  }
  bool any = false;
  for (int bx = 0, x = 0; x < size.x(); ++bx) {
    uint16_t highest = 0;
    for (const int end = std::min(size.x(), x + block); x < end; ++x) highest = std::max(highest, ranks[x]);
    marks[bx] = highest > rule.limit ? 1 : 0;
    any |= highest > rule.limit;
  }
  return any;
}

/// Writes the squares of the distances along x to the nearest mark into a row with `reach` more blocks at each end.
void TransformRow(const std::vector<uint8_t>& marks, int reach, uint16_t* row) {
  const int blocks = static_cast<int>(marks.size());
  const int width = blocks + 2 * reach;
  std::vector<int> steps(width, reach + 1);
  for (int x = 0; x < width; ++x) {
    const bool marked = x >= reach && x < reach + blocks && marks[x - reach] != 0;
    steps[x] = marked ? 0 : (x == 0 ? reach + 1 : std::min(steps[x - 1] + 1, reach + 1));
  }
  for (int x = width - 2; x >= 0; --x) steps[x] = std::min(steps[x], steps[x + 1] + 1);
  for (int x = 0; x < width; ++x) row[x] = steps[x] > reach ? kFar : CalcSquare(steps[x]);
}

/// to[x] = min(to[x], from[x] + square).
void Lower(const uint16_t* from, uint16_t square, int width, uint16_t* to) {
  for (int x = 0; x < width; ++x) to[x] = std::min<uint16_t>(to[x], static_cast<uint16_t>(from[x] + square));
}

bool IsFar(const uint16_t* row, int width) {
  return std::all_of(row, row + width, [](uint16_t square) { return square >= kFar; });
}

/// Distances along x: a field padded in x.
Field TransformX(const VoxelGrid& grid, const ObstacleRule& rule, int block, const Eigen::Vector3i& blocks, int reach) {
  Field field({blocks.x() + 2 * reach, blocks.y(), blocks.z()});
  std::vector<uint8_t> marks(blocks.x());
  std::vector<uint16_t> ranks(grid.shape().size.x());
  for (int z = 0; z < blocks.z(); ++z) {
    for (int y = 0; y < blocks.y(); ++y) {
      if (MarkObstacles(grid, rule, block, y, z, ranks, marks)) TransformRow(marks, reach, field.Row(y, z));
    }
  }
  return field;
}

/// True if no square of a row is below that of another; then the other reaches everything on its side at least as well.
bool IsCovered(const uint16_t* row, const uint16_t* other, int width) {
  uint16_t lower = 0;
  for (int x = 0; x < width; ++x) lower |= row[x] < other[x] ? 1 : 0;
  return lower == 0;
}

/// Lowers the rows within reach of the i-th of `count` rows, which begin `in_step` apart; row i of `out`, rows
/// `out_step` apart and padded by `reach`, lies at its place. Only the border of a solid body reaches out: of two
/// neighbours where one covers the other, the covered one stays on its side.
void Spread(const uint16_t* in, int i, int count, size_t in_step, int width, int reach, uint16_t* out,
            size_t out_step) {
  const uint16_t* row = in + i * in_step;
  if (IsFar(row, width)) return;
  const int first = i > 0 && IsCovered(row, row - in_step, width) ? 0 : -reach;
  const int last = i + 1 < count && IsCovered(row, row + in_step, width) ? 0 : reach;
  for (int k = first; k <= last; ++k) Lower(row, CalcSquare(k), width, out + (reach + i + k) * out_step);
}

/// Adds the distances along y and pads there.
Field TransformY(const Field& in, int reach) {
  Field out({in.size.x(), in.size.y() + 2 * reach, in.size.z()});
  const auto step = static_cast<size_t>(in.size.x());
  for (int z = 0; z < in.size.z(); ++z) {
    for (int y = 0; y < in.size.y(); ++y)
      Spread(in.Row(0, z), y, in.size.y(), step, in.size.x(), reach, out.Row(0, z), step);
  }
  return out;
}

/// Adds the distances along z and pads there.
Field TransformZ(const Field& in, int reach) {
  Field out({in.size.x(), in.size.y(), in.size.z() + 2 * reach});
  const size_t step = static_cast<size_t>(in.size.x()) * in.size.y();
  for (int y = 0; y < in.size.y(); ++y) {
    for (int z = 0; z < in.size.z(); ++z)
      Spread(in.Row(y, 0), z, in.size.z(), step, in.size.x(), reach, out.Row(y, 0), step);
  }
  return out;
}

void CheckSettings(const DistanceFieldSettings& settings, double resolution_m) {
  const bool good =
      settings.cells_per_block >= 1 && settings.cells_per_block <= 16 && settings.max_distance_m > 0.0 &&
      settings.max_distance_m <= DistanceField::kMaxReach_blocks * settings.cells_per_block * resolution_m &&
      settings.free_max_probability > 0.0 && settings.free_max_probability < 0.95;
  if (good) return;
  throw std::invalid_argument("DistanceField: " + std::to_string(settings.cells_per_block) + " cells per block up to " +
                              std::to_string(settings.max_distance_m) +
                              " m, free up to p = " + std::to_string(settings.free_max_probability));
}

}  // namespace

DistanceField::DistanceField(const VoxelGrid& grid, Obstacles obstacles, const DistanceFieldSettings& settings)
    : max_distance_m_(settings.max_distance_m) {
  CheckSettings(settings, grid.shape().resolution_m);
  const int block = settings.cells_per_block;
  block_m_ = block * grid.shape().resolution_m;
  // One block beyond the cut-off: what is out of reach of a block's centre is further away than that from every point
  // between it and its neighbours.
  const int reach = static_cast<int>(std::ceil(max_distance_m_ / block_m_ - 1e-9)) + 1;
  const Eigen::Vector3i blocks = (grid.shape().size.array() + (block - 1)) / block;
  origin_W_ = grid.shape().origin_W.array() - (reach - 0.5) * block_m_;
  size_ = blocks.array() + 2 * reach;
  const ObstacleRule rule = MakeRule(obstacles, CalcLogOdds(settings.free_max_probability));
  squares_ = TransformZ(TransformY(TransformX(grid, rule, block, blocks, reach), reach), reach).squares;
  const uint16_t out_of_reach = CalcSquare(reach + 1);
  for (uint16_t& square : squares_) square = std::min(square, out_of_reach);
}

double DistanceField::CalcDistance(const Eigen::Vector3d& p_W) const {
  const Eigen::Array3d at = (p_W - origin_W_).array() / block_m_;
  const Eigen::Array3d low = at.floor();
  if (!((low >= 0.0).all() && (low < (size_.array() - 1).cast<double>()).all())) return max_distance_m_;
  const Eigen::Array3d f = at - low;
  const size_t plane = static_cast<size_t>(size_.x()) * size_.y();
  const uint16_t* corner = squares_.data() + static_cast<size_t>(low.z()) * plane +
                           static_cast<size_t>(low.y()) * size_.x() + static_cast<size_t>(low.x());
  const auto along_x = [&](const uint16_t* row) { return row[0] + f.x() * (row[1] - row[0]); };
  const auto along_y = [&](const uint16_t* layer) {
    const double first = along_x(layer);
    return first + f.y() * (along_x(layer + size_.x()) - first);
  };
  const double first = along_y(corner);
  const double mean = first + f.z() * (along_y(corner + plane) - first);
  // d^2 - |p|^2 is a minimum of linear functions of p, thus concave, and its interpolation between the centres never
  // above it. Squares count half edges.
  const double square = 0.25 * mean - (f * (1.0 - f)).sum();
  return std::clamp(std::sqrt(std::max(square, 0.0)) * block_m_, 0.0, max_distance_m_);
}

}  // namespace nbs
