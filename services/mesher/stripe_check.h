#pragma once

#include "common/sensing/profiler.h"
#include "services/mesher/brick_grid.h"

namespace nbs {

/// True if a stripe can be measured with: one range a beam, a rigid pose no further than 500 m off. Nothing is asked of
/// a closing stripe, which has neither.
inline bool IsMeasurable(const Profiler& profiler, const Stripe& stripe) {
  if (stripe.end_of_scan) return true;
  return static_cast<int>(stripe.ranges_m.size()) == profiler.points && IsRigid(stripe.X_WS) &&
         stripe.X_WS.translation().cwiseAbs().maxCoeff() <= 0.5 * BrickGrid::kReach_m;
}

}  // namespace nbs
