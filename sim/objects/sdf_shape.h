#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "common/geometry/pose.h"

namespace nbs {

// Solids in their own frame P, lengths in any one unit. Each has Distance(p_P): negative inside, zero on the surface,
// and near the surface the distance to it. Formulas after Quilez, "Distance functions"
// (iquilezles.org/articles/distfunctions), and Hart, "Sphere tracing", The Visual Computer 12, 1996.

/// Half axes along x, y, z. The distance is a first-order bound, not exact.
struct Ellipsoid {
  Eigen::Vector3d half_axes = Eigen::Vector3d::Ones();
  double Distance(const Eigen::Vector3d& p_P) const;
};

/// Hull of a ball of radius_a at the origin and one of radius_b at z = length, length > |radius_a - radius_b|.
struct RoundCone {
  double length = 1.0;
  double radius_a = 1.0;
  double radius_b = 1.0;
  double Distance(const Eigen::Vector3d& p_P) const;
};

/// Ring in the plane z = 0.
struct Torus {
  double ring_radius = 1.0;
  double tube_radius = 0.1;
  double Distance(const Eigen::Vector3d& p_P) const;
};

/// Upright cylinder around z, edges rounded, optionally with flutes cut into its side.
struct Cylinder {
  double radius = 1.0;
  double half_height = 1.0;
  double rounding = 0.0;
  int flutes = 0;
  double flute_depth = 0.0;
  double Distance(const Eigen::Vector3d& p_P) const;
};

/// Open bowl: the part below z = rim_height of a hollow ball around the origin.
struct Bowl {
  double radius = 1.0;  ///< Of the middle of the wall; > |rim_height|.
  double rim_height = 0.0;
  double thickness = 0.1;
  double Distance(const Eigen::Vector3d& p_P) const;
};

/// Hanging cloth: a sheet near the plane y = 0, |x| <= half_width at the foot and half_width * gather at the head, |z|
/// <= half_height, with folds that run down it and grow deeper towards the foot.
struct Cloth {
  double half_width = 1.0;
  double half_height = 1.0;
  double thickness = 0.1;
  double gather = 0.6;
  double fold_depth = 0.1;
  int folds = 5;
  double bend = 0.0;  ///< How far the sides bend towards +y.
  double sway = 0.0;  ///< How far the middle of the height bulges towards +y.
  double Distance(const Eigen::Vector3d& p_P) const;

 private:
  /// Offset of the sheet along y, `across` from -1 to 1, `down` from 0 at the head to 1 at the foot.
  double CalcOffset(double across, double down) const;
};

using Solid = std::variant<Ellipsoid, RoundCone, Torus, Cylinder, Bowl, Cloth>;

/// A shape made step by step: each solid is added to, or cut out of, what the steps before it made, with a rounded
/// seam.
class SdfShape {
 public:
  /// How a step joins what is there.
  struct Seam {
    double blend = 0.0;        ///< Width of the rounding; 0: a sharp seam.
    double ripple = 0.0;       ///< Amplitude of the bumps on the solid.
    double ripple_size = 1.0;  ///< Length of a bump.
  };

  void Add(const Solid& solid, const Pose& X_OP, const Seam& seam) {
    steps_.push_back({solid, X_OP.inverse(), seam, false});
  }
  void Cut(const Solid& solid, const Pose& X_OP, const Seam& seam) {
    steps_.push_back({solid, X_OP.inverse(), seam, true});
  }

  /// Numbers of all steps.
  std::vector<uint16_t> AllSteps() const;

  /// Those of the given steps (ascending) that matter for the surface in the ball around p_O: without the others the
  /// surface there stays as it is.
  std::vector<uint16_t> FindSteps(const Eigen::Vector3d& p_O, double radius, std::span<const uint16_t> steps) const;

  /// Signed distance after the given steps (ascending); a bound of it where seams are rounded.
  double Evaluate(const Eigen::Vector3d& p_O, std::span<const uint16_t> steps) const;

  /// Distance and gradient by forward differences over `step`.
  struct Slope {
    double distance = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  };
  Slope CalcSlope(const Eigen::Vector3d& p_O, std::span<const uint16_t> steps, double step) const;

  size_t size() const { return steps_.size(); }

 private:
  struct Step {
    Solid solid;
    Pose X_PO;
    Seam seam;
    bool cut = false;
    double Distance(const Eigen::Vector3d& p_O) const;
    double Join(double running, double distance) const;
  };
  std::vector<Step> steps_;
};

}  // namespace nbs
