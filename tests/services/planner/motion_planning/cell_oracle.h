#pragma once

#include <cmath>

#include "common/kinematics/arm_body.h"
#include "common/kinematics/shape_distance.h"
#include "common/mapping/distance_field.h"
#include "common/mapping/voxel_grid.h"

namespace nbs {

/// Whether bodies touch the obstacle cells of a grid, cell by cell, without any structure over them.
class CellOracle {
 public:
  CellOracle(const VoxelGrid& grid, Obstacles obstacles, double free_max_probability)
      : grid_(grid), obstacles_(obstacles), free_(CalcLogOdds(free_max_probability)) {}

  bool IsTouched(const Capsule& capsule_W) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(capsule_W.radius_m);
    const Eigen::AlignedBox3d box_W(capsule_W.p_A.cwiseMin(capsule_W.p_B) - reach,
                                    capsule_W.p_A.cwiseMax(capsule_W.p_B) + reach);
    return AnyCell(box_W, [&](const Eigen::Vector3d& middle_W, const Eigen::Vector3d& half) {
      return FindLineDistance(capsule_W.p_A - middle_W, capsule_W.p_B - middle_W, half) < capsule_W.radius_m;
    });
  }

  bool IsTouched(const Block& block_W, double margin_m) const {
    const Eigen::Vector3d reach = block_W.X_LC.linear().cwiseAbs() * block_W.half + Eigen::Vector3d::Constant(margin_m);
    const Eigen::Vector3d p_W = block_W.X_LC.translation();
    return AnyCell({p_W - reach, p_W + reach}, [&](const Eigen::Vector3d& middle_W, const Eigen::Vector3d& half) {
      return FindBlockDistance(block_W, middle_W, half) < margin_m;
    });
  }

  /// The whole arm with the margin around every part.
  bool IsTouched(const ArmBody& body, const Pose& X_WB, const LinkPoses& X_BL, double margin_m) const {
    for (const ArmPart& part : body.parts()) {
      const Pose X_WL = X_WB * X_BL[static_cast<size_t>(part.link)];
      for (const Capsule& c : part.capsules) {
        if (IsTouched({X_WL * c.p_A, X_WL * c.p_B, c.radius_m + margin_m})) return true;
      }
      for (const Block& block : part.blocks) {
        if (IsTouched({X_WL * block.X_LC, block.half}, margin_m)) return true;
      }
    }
    return false;
  }

 private:
  /// By ternary search: the distance from a box is convex along a line.
  static double FindLineDistance(const Eigen::Vector3d& p_A, const Eigen::Vector3d& p_B, const Eigen::Vector3d& half) {
    const Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    const double to_ball = CalcSegmentDistance(p_A, p_B, middle, middle) - half.norm();
    if (to_ball > 0.3) return to_ball;
    double low = 0.0;
    double high = 1.0;
    const auto at = [&](double share) { return CalcBoxDistance(p_A + share * (p_B - p_A), half); };
    while (high - low > 1e-7) {
      const double third = (high - low) / 3.0;
      (at(low + third) > at(high - third) ? low : high) += at(low + third) > at(high - third) ? third : -third;
    }
    return at(0.5 * (low + high));
  }

  /// By alternating projections between the two convex bodies (Cheney & Goldstein 1959).
  static double FindBlockDistance(const Block& block, const Eigen::Vector3d& middle, const Eigen::Vector3d& half) {
    Eigen::Vector3d p = middle;
    Eigen::Vector3d q = p;
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d p_C = block.X_LC.inverse() * p;
      q = block.X_LC * p_C.cwiseMax(-block.half).cwiseMin(block.half);
      const Eigen::Vector3d next = middle + (q - middle).cwiseMax(-half).cwiseMin(half);
      if ((next - p).norm() < 1e-13) break;
      p = next;
    }
    return (p - q).norm();
  }

  template <typename Test>
  bool AnyCell(const Eigen::AlignedBox3d& box_W, const Test& test) const {
    const GridShape& shape = grid_.shape();
    const auto cell_of = [&](const Eigen::Vector3d& p_W) -> Eigen::Vector3i {
      const Eigen::Array3d at = ((p_W - shape.origin_W) / shape.resolution_m).array().floor();
      return at.max(-1.0).min(shape.size.array().cast<double>()).cast<int>();
    };
    const Eigen::Vector3i low = (cell_of(box_W.min()).array() - 1).max(0);
    const Eigen::Vector3i high = (cell_of(box_W.max()).array() + 1).min(shape.size.array() - 1);
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * shape.resolution_m);
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          const int16_t l = grid_.At(x, y, z);
          const bool is_obstacle =
              IsOccupied(l) || (obstacles_ != Obstacles::kOccupied && (l > free_ || l == kUnobserved));
          if (is_obstacle && test(shape.origin_W + 2.0 * half.x() * (Eigen::Array3d(x, y, z) + 0.5).matrix(), half))
            return true;
        }
      }
    }
    return false;
  }

  const VoxelGrid& grid_;
  Obstacles obstacles_;
  int16_t free_;
};

}  // namespace nbs
