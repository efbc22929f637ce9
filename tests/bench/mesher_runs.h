#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/geometry/mesh_delta.h"
#include "services/mesher/mesher_node.h"

namespace nbs::bench {

/// CPU time of this thread so far.
double CpuSeconds();

/// Bytes on the heap.
int64_t CountHeapBytes();

/// The mesher's service, fed with stripes as in a run.
struct MesherRun {
  std::unique_ptr<MesherNode> node;
  MeshReplica replica;
  double seconds = 0.0;                ///< CPU time of the node alone.
  std::vector<double> stripe_seconds;  ///< Of each stripe, deltas and figures included.
  int64_t points = 0;
};

MesherRun RunMesher(const Profiler& profiler, std::span<const Stripe> stripes, bool keep_replica);

/// Stripe number `n` of an endless scan over hills 40 mm high: lanes of 500 stripes, each lane a scan, 250 mm beside
/// the one before, so that they overlap by a sixth.
Stripe MakeHillStripe(const Profiler& profiler, int64_t n);

}  // namespace nbs::bench
