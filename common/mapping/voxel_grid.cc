#include "common/mapping/voxel_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr int32_t kMaxLogOdds = 32767;

void CheckShape(const GridShape& shape) {
  if (!std::isfinite(shape.resolution_m) || shape.resolution_m <= 0.0 || !shape.origin_W.allFinite()) {
    throw ConfigError("the voxel grid's resolution must be positive and its origin finite, but the resolution is " +
                      std::to_string(shape.resolution_m) + " m");
  }
  int64_t cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int size = shape.size[axis];
    if (size < 1)
      throw ConfigError("the voxel grid has " + std::to_string(size) + " cells along an axis: make the box larger");
    // Sides are below 2^31, so the product cannot overflow before it is refused.
    cells *= size;
    if (cells > kMaxGridCells) {
      throw ConfigError("the voxel grid has more than " + std::to_string(kMaxGridCells) +
                        " cells: choose a coarser resolution_m or a smaller box");
    }
    const double origin_cells = shape.origin_W[axis] / shape.resolution_m;
    if (std::abs(origin_cells - std::round(origin_cells)) > 1e-6) {
      throw ConfigError("the voxel grid's origin " + std::to_string(shape.origin_W[axis]) +
                        " m is no multiple of its resolution");
    }
  }
}

double CalcEntropy(double probability) {
  if (probability <= 0.0 || probability >= 1.0) return 0.0;
  return -probability * std::log(probability) - (1.0 - probability) * std::log1p(-probability);
}

void CheckRuns(const VoxelDelta& delta, int64_t cells) {
  if (delta.run_start.size() != delta.run_length.size())
    throw std::invalid_argument("VoxelGrid::Apply: runs without a length");
  int64_t end = 0;
  size_t values = 0;
  for (size_t i = 0; i < delta.run_start.size(); ++i) {
    const bool ascends = static_cast<int64_t>(delta.run_start[i]) >= end && delta.run_length[i] > 0;
    end = static_cast<int64_t>(delta.run_start[i]) + delta.run_length[i];
    if (!ascends || end > cells)
      throw std::invalid_argument("VoxelGrid::Apply: bad run at cell " + std::to_string(delta.run_start[i]));
    values += delta.run_length[i];
  }
  if (values != delta.values.size()) throw std::invalid_argument("VoxelGrid::Apply: runs and values disagree");
}

}  // namespace

double CalcProbability(int16_t log_odds) {
  if (log_odds == kUnobserved) return 0.5;
  return 1.0 / (1.0 + std::exp(-log_odds / kLogOddsPerNat));
}

int16_t CalcLogOdds(double probability) {
  if (!(probability > 0.0 && probability < 1.0)) {
    throw std::invalid_argument("CalcLogOdds: probability " + std::to_string(probability) + " is not in (0, 1)");
  }
  const double nats = std::log(probability) - std::log1p(-probability);
  const double limit = kMaxLogOdds;
  return static_cast<int16_t>(std::lround(std::clamp(nats * kLogOddsPerNat, -limit, limit)));
}

std::span<const uint16_t, 65536> EntropyTable() {
  using Table = std::array<uint16_t, 65536>;
  static const std::unique_ptr<const Table> table = [] {
    auto made = std::make_unique<Table>();
    for (int l = std::numeric_limits<int16_t>::min(); l <= kMaxLogOdds; ++l) {
      const double nats = CalcEntropy(CalcProbability(static_cast<int16_t>(l)));
      (*made)[static_cast<uint16_t>(l)] = static_cast<uint16_t>(std::lround(nats * kEntropyPerNat));
    }
    return made;
  }();
  return *table;
}

VoxelGrid::VoxelGrid(const GridShape& shape) : shape_(shape) {
  CheckShape(shape);
  cells_.assign(shape.cells(), kUnobserved);
}

void VoxelGrid::Apply(const VoxelDelta& delta) {
  CheckRuns(delta, shape_.cells());
  auto value = delta.values.begin();
  for (size_t i = 0; i < delta.run_start.size(); ++i) {
    std::copy_n(value, delta.run_length[i], cells_.begin() + delta.run_start[i]);
    value += delta.run_length[i];
  }
}

VoxelDelta ChangeTracker::TakeDelta(const VoxelGrid& grid) {
  VoxelDelta delta;
  int64_t run_end = -1;
  std::sort(marked_words_.begin(), marked_words_.end());
  for (const uint32_t word_index : marked_words_) {
    for (uint64_t word = words_[word_index]; word != 0; word &= word - 1) {
      const int64_t index = static_cast<int64_t>(word_index) * 64 + std::countr_zero(word);
      if (index == run_end && delta.run_length.back() < std::numeric_limits<uint16_t>::max()) {
        ++delta.run_length.back();
      } else {
        delta.run_start.push_back(static_cast<uint32_t>(index));
        delta.run_length.push_back(1);
      }
      delta.values.push_back(grid.cells()[index]);
      run_end = index + 1;
    }
    words_[word_index] = 0;
  }
  marked_words_.clear();
  return delta;
}

}  // namespace nbs
