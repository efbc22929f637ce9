#pragma once

#include "common/config/run_config.h"
#include "common/runtime/node.h"
#include "services/mesher/streaming_mesher.h"

namespace nbs {

/// The mesher without the bus: stripes in; mesh changes and, once a scan, the figures of the mesh out.
///
/// Reads stripes, nothing else, for as long as it runs. After each 25th stripe of a scan (numbers 24, 49, ...) it
/// publishes a MeshDelta; on the closing stripe the last MeshDelta of the scan, with end_of_scan set, and after it the
/// MeshScan. Both come even if nothing was seen. Refused stripes give nothing.
class MesherNode : public Node {
 public:
  explicit MesherNode(const RunConfig& config, const StreamingMesherSettings& settings = {})
      : mesher_(config.cell.profiler, settings) {}

  size_t NextInput() const override { return StreamOf<Stripe>(); }
  void Handle(const Message& message, Outbox& out) override;
  std::vector<Count> Complaints() const override;

 private:
  StreamingMesher mesher_;
};

}  // namespace nbs
