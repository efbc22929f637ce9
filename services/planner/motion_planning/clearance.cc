#include "services/planner/motion_planning/clearance.h"

#include "common/kinematics/shape_distance.h"

namespace nbs {

bool Clearance::IsTouched(Obstacles obstacles, const Capsule& capsule_W) const {
  constexpr double kShort = 1e-4;  // metres
  const Eigen::Vector3d middle_W = 0.5 * (capsule_W.p_A + capsule_W.p_B);
  const double half = 0.5 * (capsule_W.p_B - capsule_W.p_A).norm();
  const double distance = CalcDistance(obstacles, middle_W);
  if (distance < capsule_W.radius_m) return true;
  if (distance >= capsule_W.radius_m + half) return false;
  if (half < kShort) return true;
  return IsTouched(obstacles, Capsule{capsule_W.p_A, middle_W, capsule_W.radius_m}) ||
         IsTouched(obstacles, Capsule{middle_W, capsule_W.p_B, capsule_W.radius_m});
}

bool Clearance::IsTouched(Obstacles obstacles, const Block& block_W, double margin_m) const {
  const std::vector<Capsule> capsules_W = CoverBlock(block_W);
  return std::any_of(capsules_W.begin(), capsules_W.end(), [&](const Capsule& c) {
    return IsTouched(obstacles, Capsule{c.p_A, c.p_B, c.radius_m + margin_m});
  });
}

}  // namespace nbs
