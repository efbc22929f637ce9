#pragma once

#include <span>
#include <vector>

#include "common/config/run_config.h"
#include "sim/scene.h"

namespace nbs {

/// How near the sensor's body came to the true object.
struct Contacts {
  int states = 0;    ///< Looked at.
  int touching = 0;  ///< In which a sphere of the body met the object's surface.
  double nearest_m =
      0.0;  ///< Smallest distance between body and surface, not above kContactReach_m; negative: how deep.
};

inline constexpr double kContactReach_m = 0.5;

/// Checks the body of the sensor at each pose. A sphere that lies wholly inside of the object, without meeting its
/// surface, is not noticed; one that moves there in small steps meets the surface on its way.
Contacts FindContacts(const TriangleScene& object_W, const std::vector<Sphere>& body_S, std::span<const Pose> poses_WS);

}  // namespace nbs
