#pragma once

#include <vector>

#include "common/runtime/node.h"

namespace nbs {

/// A run's stripes where registration has put them, and the mesh that they give.
struct Registered {
  Outbox stripes;  ///< Stripe by Stripe.
  Outbox mesh;     ///< One MeshDelta with everything, and the MeshScan of the last scan.
};

/// Registers the scans with each other (MakeRegisteredStripes) and folds their stripes into a new mesh. The same
/// stripes give the same bits.
///
/// @param stripes  At least one, in the order in which they came. A last scan that was cut short counts as closed.
/// @throws std::invalid_argument if there are none.
Registered Remesh(const Profiler& profiler, std::vector<Stripe> stripes);

}  // namespace nbs
