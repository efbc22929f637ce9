#include "services/planner/motion_planning/collision_body.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace nbs {
namespace {

/// Sphere about the middle of the spheres' bounding box that holds them all.
Sphere MakeBound(const std::vector<Sphere>& spheres) {
  Eigen::AlignedBox3d box;
  for (const Sphere& sphere : spheres) {
    box.extend((sphere.center.array() - sphere.radius_m).matrix());
    box.extend((sphere.center.array() + sphere.radius_m).matrix());
  }
  Sphere bound{box.center(), 0.0};
  for (const Sphere& sphere : spheres) {
    bound.radius_m = std::max(bound.radius_m, (sphere.center - bound.center).norm() + sphere.radius_m);
  }
  return bound;
}

}  // namespace

CollisionBody::CollisionBody(std::vector<Sphere> spheres_B, double margin_m)
    : spheres_B_(std::move(spheres_B)), margin_m_(margin_m) {
  if (spheres_B_.empty()) throw std::invalid_argument("CollisionBody: no spheres");
  if (!std::isfinite(margin_m_)) throw std::invalid_argument("CollisionBody: the margin is not finite");
  for (const Sphere& sphere : spheres_B_) {
    if (!sphere.center.allFinite() || !(sphere.radius_m > 0.0) || !std::isfinite(sphere.radius_m)) {
      throw std::invalid_argument("CollisionBody: a sphere of radius " + std::to_string(sphere.radius_m) + " m");
    }
  }
  bound_B_ = MakeBound(spheres_B_);
}

double CollisionBody::CalcSlack(const Clearance& clearance, const Pose& X_WB) const {
  double slack = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : spheres_B_) {
    slack = std::min(slack, clearance.CalcUnknownDistance(X_WB * sphere.center) - sphere.radius_m - margin_m_);
  }
  return slack;
}

Touch CollisionBody::FindTouch(const Clearance& clearance, const Pose& X_WB) const {
  if (CalcSlack(clearance, X_WB) >= 0.0) return Touch::kFree;
  for (const Sphere& sphere : spheres_B_) {
    if (clearance.CalcObstacleDistance(X_WB * sphere.center) - sphere.radius_m - margin_m_ < 0.0)
      return Touch::kOccupied;
  }
  return Touch::kUnknown;
}

std::vector<Sphere> MoveSpheres(const Pose& X_FS, const std::vector<Sphere>& spheres_S) {
  std::vector<Sphere> spheres_F = spheres_S;
  for (Sphere& sphere : spheres_F) sphere.center = X_FS * sphere.center;
  return spheres_F;
}

}  // namespace nbs
