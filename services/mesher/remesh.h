#pragma once

#include <vector>

#include "common/runtime/node.h"

namespace nbs {

/// A run's stripes where registration has put them, and the mesh that they give.
struct Registered {
  Outbox stripes;  ///< Stripe by Stripe.
  Outbox mesh;     ///< One MeshDelta with everything, and the MeshScan of the last scan.
};

/// The stripes up to the last that closes a scan; what an interrupted scan has left is dropped.
std::vector<Stripe> KeepWholeScans(std::vector<Stripe> stripes);

/// Registers the scans with each other (MakeRegisteredStripes) and folds their stripes into a new mesh. The same
/// stripes give the same bits.
///
/// @param stripes  Of whole scans, in the order in which they came.
Registered Remesh(const Profiler& profiler, std::vector<Stripe> stripes);

}  // namespace nbs
