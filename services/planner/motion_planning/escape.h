#pragma once

#include <optional>

#include "services/planner/motion_planning/swept_check.h"

namespace nbs {

/// Where a body that stands nearer to something than its margin can go to have its margin again: a short straight
/// motion that on its way comes no nearer to anything than the body stands now.
///
/// A map that has learnt more may leave a standing robot within its margin; without this it could never move again.
/// Tries the directions backwards
/// (-z of S), sideways and forwards, near before far, up to 0.2 m.
///
/// @param R_WS  Orientation of the sensor; its axes are the directions.
/// @returns X_WF_now itself if it keeps the margin; nothing if the body touches even without margin, or no direction
/// helps.
std::optional<Pose> FindEscape(const CollisionBody& body_F, const Clearance& clearance, const Pose& X_WF_now,
                               const Eigen::Matrix3d& R_WS);

}  // namespace nbs
