#include "sim/objects/sample_grid.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr int kBlock = 4;   ///< Samples along a block's edge.
constexpr int kRegion = 6;  ///< Blocks along a region's edge.
/// A shape's bound may fall short of the distance by this factor.
constexpr double kSlack = 1.3;

/// The corners of a cell are numbered by bits: 1 along x, 2 along y, 4 along z. Its six faces, each in the order
/// around.
constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};

/// True if the corners, one bit each, break well-composedness.
bool IsCritical(unsigned inside) {
  for (const auto& face : kFaces) {
    const unsigned a = inside >> face[0] & 1u, b = inside >> face[1] & 1u, c = inside >> face[2] & 1u,
                   d = inside >> face[3] & 1u;
    if (a == c && b == d && a != b) return true;
  }
  for (unsigned corner = 0; corner < 4; ++corner) {
    const unsigned pair = 1u << corner | 1u << (7 - corner);
    if (inside == pair || inside == (0xffu & ~pair)) return true;
  }
  return false;
}

}  // namespace

SampleGrid::SampleGrid(const SdfShape& shape, const Eigen::AlignedBox3d& box, double spacing)
    : origin_(box.min()), spacing_(spacing) {
  std::array<int, 3> regions;
  for (int axis = 0; axis < 3; ++axis) {
    regions[axis] = static_cast<int>(std::ceil(box.sizes()[axis] / (spacing * kBlock * kRegion)));
    blocks_[axis] = regions[axis] * kRegion;
    size_[axis] = blocks_[axis] * kBlock;
  }
  values_.resize(static_cast<size_t>(size_[0]) * size_[1] * size_[2]);
  steps_.resize(static_cast<size_t>(blocks_[0]) * blocks_[1] * blocks_[2]);
  for (int z = 0; z < regions[2]; ++z) {
    for (int y = 0; y < regions[1]; ++y) {
      for (int x = 0; x < regions[0]; ++x) SampleRegion(shape, {x, y, z});
    }
  }
}

size_t SampleGrid::BlockIndex(const std::array<int, 3>& block) const {
  return (static_cast<size_t>(block[2]) * blocks_[1] + block[1]) * blocks_[0] + block[0];
}

void SampleGrid::SampleRegion(const SdfShape& shape, const std::array<int, 3>& region) {
  constexpr int kSamples = kBlock * kRegion;
  const Vector3d middle =
      origin_ + spacing_ * kSamples * (Vector3d(region[0], region[1], region[2]).array() + 0.5).matrix();
  const double radius = spacing_ * (0.5 * kSamples * std::sqrt(3.0) + 2.0);
  const std::vector<uint16_t> candidates = shape.FindSteps(middle, radius, shape.AllSteps());
  for (int z = 0; z < kRegion; ++z) {
    for (int y = 0; y < kRegion; ++y) {
      for (int x = 0; x < kRegion; ++x) {
        SampleBlock(shape, candidates, {region[0] * kRegion + x, region[1] * kRegion + y, region[2] * kRegion + z});
      }
    }
  }
}

void SampleGrid::SampleBlock(const SdfShape& shape, std::span<const uint16_t> candidates,
                             const std::array<int, 3>& block) {
  const Vector3d middle = origin_ + spacing_ * kBlock * (Vector3d(block[0], block[1], block[2]).array() + 0.5).matrix();
  // Two spacings more than the block: vertices move a little when they are relaxed.
  const double radius = spacing_ * (0.5 * kBlock * std::sqrt(3.0) + 2.0);
  std::vector<uint16_t>& steps = steps_[BlockIndex(block)];
  steps = shape.FindSteps(middle, radius, candidates);
  const double at_middle = shape.Evaluate(middle, steps);
  const bool far = std::abs(at_middle) > kSlack * radius;
  if (far) steps.clear();
  for (int z = block[2] * kBlock; z < (block[2] + 1) * kBlock; ++z) {
    for (int y = block[1] * kBlock; y < (block[1] + 1) * kBlock; ++y) {
      for (int x = block[0] * kBlock; x < (block[0] + 1) * kBlock; ++x) {
        values_[Index(x, y, z)] = static_cast<float>(far ? at_middle : shape.Evaluate(Position(x, y, z), steps));
      }
    }
  }
}

bool SampleGrid::RepairCell(int x, int y, int z) {
  unsigned bits = 0;
  std::array<size_t, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners[i] = Index(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2 & 1));
    if (inside(corners[i])) bits |= 1u << i;
  }
  if (bits == 0 || bits == 0xff || !IsCritical(bits)) return false;
  size_t nearest = corners[0];
  for (size_t corner : corners) {
    if (inside(corner)) continue;
    if (inside(nearest) || values_[corner] < values_[nearest]) nearest = corner;
  }
  values_[nearest] = -1e-6f;
  return true;
}

void SampleGrid::MakeWellComposed() {
  // Only ever adds to the inside, so it ends.
  bool changed = true;
  while (changed) {
    changed = false;
    for (int z = 0; z + 1 < size_[2]; ++z) {
      for (int y = 0; y + 1 < size_[1]; ++y) {
        for (int x = 0; x + 1 < size_[0]; ++x) changed |= RepairCell(x, y, z);
      }
    }
  }
}

const std::vector<uint16_t>& SampleGrid::StepsAt(const Vector3d& p) const {
  std::array<int, 3> block;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor((p[axis] - origin_[axis]) / (spacing_ * kBlock));
    block[axis] = static_cast<int>(std::clamp(at, 0.0, blocks_[axis] - 1.0));
  }
  return steps_[BlockIndex(block)];
}

}  // namespace nbs
