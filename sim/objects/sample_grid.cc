#include "sim/objects/sample_grid.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr int kBlock = 8;
/// A shape's bound may fall short of the distance by this factor.
constexpr double kSlack = 1.6;

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
  for (int axis = 0; axis < 3; ++axis) {
    blocks_[axis] = static_cast<int>(std::ceil(box.sizes()[axis] / (spacing * kBlock))) + 1;
    size_[axis] = blocks_[axis] * kBlock;
  }
  values_.resize(static_cast<size_t>(size_[0]) * size_[1] * size_[2]);
  steps_.resize(static_cast<size_t>(blocks_[0]) * blocks_[1] * blocks_[2]);
  for (int bz = 0; bz < blocks_[2]; ++bz) {
    for (int by = 0; by < blocks_[1]; ++by) {
      for (int bx = 0; bx < blocks_[0]; ++bx) SampleBlock(shape, bx, by, bz);
    }
  }
}

void SampleGrid::SampleBlock(const SdfShape& shape, int bx, int by, int bz) {
  const Vector3d middle = origin_ + spacing_ * kBlock * (Vector3d(bx, by, bz).array() + 0.5).matrix();
  // Two spacings more than the block: vertices move a little when they are relaxed.
  const double radius = spacing_ * (0.5 * kBlock * std::sqrt(3.0) + 2.0);
  std::vector<uint16_t>& steps = steps_[(static_cast<size_t>(bz) * blocks_[1] + by) * blocks_[0] + bx];
  steps = shape.FindSteps(middle, radius);
  const double at_middle = shape.Evaluate(middle, steps);
  const bool far = std::abs(at_middle) > kSlack * radius;
  for (int z = bz * kBlock; z < (bz + 1) * kBlock; ++z) {
    for (int y = by * kBlock; y < (by + 1) * kBlock; ++y) {
      for (int x = bx * kBlock; x < (bx + 1) * kBlock; ++x) {
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
  std::array<size_t, 3> block;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor((p[axis] - origin_[axis]) / (spacing_ * kBlock));
    block[axis] = static_cast<size_t>(std::clamp(at, 0.0, blocks_[axis] - 1.0));
  }
  return steps_[(block[2] * blocks_[1] + block[1]) * blocks_[0] + block[0]];
}

}  // namespace nbs
