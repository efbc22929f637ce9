#pragma once

#include <cstdint>
#include <vector>

#include "common/config/run_config.h"
#include "common/geometry/pose.h"
#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// What a body at a pose comes nearer to than its margin. Occupied goes before unknown.
enum class Touch : uint8_t { kFree = 0, kUnknown = 1, kOccupied = 2 };

/// A rigid body made of spheres, with the distance that it keeps from everything.
class CollisionBody {
 public:
  /// @param spheres_B  In the body's frame B, metres; at least one, radii > 0.
  /// @param margin_m   Kept between the spheres and what they must not touch; may be negative.
  /// @throws std::invalid_argument if there is no sphere, or a number is not finite or out of range.
  CollisionBody(std::vector<Sphere> spheres_B, double margin_m);

  const std::vector<Sphere>& spheres_B() const { return spheres_B_; }
  /// A sphere around all the others.
  const Sphere& bound_B() const { return bound_B_; }
  double margin_m() const { return margin_m_; }

  /// Smallest distance between a sphere of the body at X_WB and anything occupied or unknown, metres, the margin taken
  /// off; negative: too near.
  double CalcSlack(const Clearance& clearance, const Pose& X_WB) const;

  /// kFree exactly if CalcSlack is not negative.
  Touch FindTouch(const Clearance& clearance, const Pose& X_WB) const;

  /// The same body with another margin.
  CollisionBody WithMargin(double margin_m) const { return {spheres_B_, margin_m}; }

 private:
  std::vector<Sphere> spheres_B_;
  Sphere bound_B_;
  double margin_m_ = 0.0;
};

/// The spheres, moved from the sensor's frame into the flange's.
std::vector<Sphere> MoveSpheres(const Pose& X_FS, const std::vector<Sphere>& spheres_S);

}  // namespace nbs
