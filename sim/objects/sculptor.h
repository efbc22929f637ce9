#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/objects/sdf_shape.h"

namespace nbs {

/// Builds a shape from solids that are placed by points instead of poses. Points are given in the current frame P;
/// lengths in the shape's unit.
class Sculptor {
 public:
  explicit Sculptor(SdfShape& shape) : shape_(shape) {}

  using Seam = SdfShape::Seam;
  using Vector3d = Eigen::Vector3d;

  /// Frame of all further points, in the shape's frame.
  void SetFrame(const Pose& X_OP) { X_OP_ = X_OP; }

  void Ball(const Vector3d& center, double radius, const Seam& seam);
  /// Ellipsoid, turned so that its z axis lies along `axis`.
  void Egg(const Vector3d& center, const Vector3d& half_axes, const Seam& seam,
           const Vector3d& axis = Vector3d::UnitZ());
  /// Round cone between two points.
  void Limb(const Vector3d& from, double radius_from, const Vector3d& to, double radius_to, const Seam& seam);
  /// Chain of round cones; radii[i] belongs to points[i].
  void Chain(const std::vector<Vector3d>& points, const std::vector<double>& radii, const Seam& seam);
  /// Ring around `axis`.
  void Ring(const Vector3d& center, const Vector3d& axis, double ring_radius, double tube_radius, const Seam& seam);
  void CutBall(const Vector3d& center, double radius, const Seam& seam);
  void CutEgg(const Vector3d& center, const Vector3d& half_axes, const Seam& seam,
              const Vector3d& axis = Vector3d::UnitZ());
  void CutLimb(const Vector3d& from, double radius_from, const Vector3d& to, double radius_to, const Seam& seam);
  void CutRing(const Vector3d& center, const Vector3d& axis, double ring_radius, double tube_radius, const Seam& seam);
  /// Any solid, in a frame at `origin` whose z axis lies along `axis` and whose x axis is as near as may be to
  /// `x_hint`.
  void Place(const Solid& solid, const Vector3d& origin, const Vector3d& axis, const Vector3d& x_hint,
             const Seam& seam);

 private:
  Pose MakeFrame(const Vector3d& origin, const Vector3d& axis, const Vector3d& x_hint) const;

  SdfShape& shape_;
  Pose X_OP_ = Pose::Identity();
};

}  // namespace nbs
