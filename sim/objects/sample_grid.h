#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/objects/sdf_shape.h"

namespace nbs {

/// Samples of a shape's signed distance on a regular grid, and for each block of it the steps that matter there.
class SampleGrid {
 public:
  /// Samples exactly near the surface; elsewhere only the sign is right.
  SampleGrid(const SdfShape& shape, const Eigen::AlignedBox3d& box, double spacing);

  /// Adds samples to the inside, those nearest to the surface first, until the inside is well-composed: then the faces
  /// between inner and outer samples form a 2-manifold.
  void MakeWellComposed();

  const std::array<int, 3>& size() const { return size_; }
  Eigen::Vector3d Position(int x, int y, int z) const { return origin_ + spacing_ * Eigen::Vector3d(x, y, z); }
  size_t Index(int x, int y, int z) const { return (static_cast<size_t>(z) * size_[1] + y) * size_[0] + x; }
  float value(size_t index) const { return values_[index]; }
  bool inside(size_t index) const { return values_[index] < 0.0f; }
  const std::vector<uint16_t>& StepsAt(const Eigen::Vector3d& p) const;

 private:
  void SampleRegion(const SdfShape& shape, const std::array<int, 3>& region);
  void SampleBlock(const SdfShape& shape, std::span<const uint16_t> candidates, const std::array<int, 3>& block);
  size_t BlockIndex(const std::array<int, 3>& block) const;
  bool RepairCell(int x, int y, int z);

  Eigen::Vector3d origin_;
  double spacing_;
  std::array<int, 3> size_;
  std::array<int, 3> blocks_;
  std::vector<float> values_;
  std::vector<std::vector<uint16_t>> steps_;
};

}  // namespace nbs
