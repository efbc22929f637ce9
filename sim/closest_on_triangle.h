#pragma once

#include <Eigen/Core>

namespace nbs {

/// Point of the closed triangle abc that is closest to p, all in one frame, metres. A triangle without area counts as
/// its edges. After Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
Eigen::Vector3d CalcClosestOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                      const Eigen::Vector3d& c);

}  // namespace nbs
