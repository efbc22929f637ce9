#include "sim/objects/sculptor.h"

#include <cmath>

namespace nbs {

Pose Sculptor::MakeFrame(const Vector3d& origin, const Vector3d& axis, const Vector3d& x_hint) const {
  const Vector3d z = axis.normalized();
  Vector3d x = x_hint - z * z.dot(x_hint);
  if (x.norm() < 1e-3) x = z.unitOrthogonal();
  x.normalize();
  Pose X_PS = Pose::Identity();
  X_PS.linear().col(0) = x;
  X_PS.linear().col(1) = z.cross(x);
  X_PS.linear().col(2) = z;
  X_PS.translation() = origin;
  return X_OP_ * X_PS;
}

void Sculptor::Place(const Solid& solid, const Vector3d& origin, const Vector3d& axis, const Vector3d& x_hint,
                     const Seam& seam) {
  shape_.Add(solid, MakeFrame(origin, axis, x_hint), seam);
}

void Sculptor::Ball(const Vector3d& center, double radius, const Seam& seam) {
  Egg(center, Vector3d::Constant(radius), seam);
}

void Sculptor::Egg(const Vector3d& center, const Vector3d& half_axes, const Seam& seam, const Vector3d& axis) {
  shape_.Add(Ellipsoid{half_axes}, MakeFrame(center, axis, Vector3d::UnitX()), seam);
}

void Sculptor::Limb(const Vector3d& from, double radius_from, const Vector3d& to, double radius_to, const Seam& seam) {
  shape_.Add(RoundCone{(to - from).norm(), radius_from, radius_to}, MakeFrame(from, to - from, Vector3d::UnitX()),
             seam);
}

void Sculptor::Chain(const std::vector<Vector3d>& points, const std::vector<double>& radii, const Seam& seam) {
  for (size_t i = 0; i + 1 < points.size(); ++i) Limb(points[i], radii.at(i), points[i + 1], radii.at(i + 1), seam);
}

void Sculptor::Ring(const Vector3d& center, const Vector3d& axis, double ring_radius, double tube_radius,
                    const Seam& seam) {
  shape_.Add(Torus{ring_radius, tube_radius}, MakeFrame(center, axis, Vector3d::UnitX()), seam);
}

void Sculptor::CutBall(const Vector3d& center, double radius, const Seam& seam) {
  CutEgg(center, Vector3d::Constant(radius), seam);
}

void Sculptor::CutEgg(const Vector3d& center, const Vector3d& half_axes, const Seam& seam, const Vector3d& axis) {
  shape_.Cut(Ellipsoid{half_axes}, MakeFrame(center, axis, Vector3d::UnitX()), seam);
}

void Sculptor::CutLimb(const Vector3d& from, double radius_from, const Vector3d& to, double radius_to,
                       const Seam& seam) {
  shape_.Cut(RoundCone{(to - from).norm(), radius_from, radius_to}, MakeFrame(from, to - from, Vector3d::UnitX()),
             seam);
}

void Sculptor::CutRing(const Vector3d& center, const Vector3d& axis, double ring_radius, double tube_radius,
                       const Seam& seam) {
  shape_.Cut(Torus{ring_radius, tube_radius}, MakeFrame(center, axis, Vector3d::UnitX()), seam);
}

}  // namespace nbs
