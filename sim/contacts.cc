#include "sim/contacts.h"

#include <algorithm>

namespace nbs {

Contacts FindContacts(const TriangleScene& object_W, const std::vector<Sphere>& body_S,
                      std::span<const Pose> poses_WS) {
  Contacts contacts;
  contacts.nearest_m = kContactReach_m;
  for (const Pose& X_WS : poses_WS) {
    double nearest = kContactReach_m;
    for (const Sphere& sphere : body_S) {
      const auto closest = object_W.FindClosest(X_WS * sphere.center, sphere.radius_m + nearest);
      if (closest) nearest = std::min(nearest, closest->distance_m - sphere.radius_m);
    }
    ++contacts.states;
    contacts.touching += nearest <= 0.0;
    contacts.nearest_m = std::min(contacts.nearest_m, nearest);
  }
  return contacts;
}

}  // namespace nbs
