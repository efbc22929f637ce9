#pragma once

#include "common/config/run_config.h"
#include "common/runtime/node.h"
#include "services/voxelmap/map_update.h"

namespace nbs {

/// Folds stripes into the probabilistic voxel space and publishes its changes: a delta every 25 accepted stripes and
/// one at the end of a scan, which comes even if nothing changed and carries end_of_scan.
///
/// Refused, counted and otherwise ignored: a stripe with the wrong number of ranges, a range that is negative or not
/// finite, a pose that is not rigid, a stripe of an earlier scan or one that is closed, and one whose index is not
/// above its predecessor's in the same scan. A closing stripe is refused only if its scan is closed.
class VoxelmapNode : public Node {
 public:
  explicit VoxelmapNode(const RunConfig& config, const InverseSensorModelSettings& settings = {});

  size_t NextInput() const override { return StreamOf<Stripe>(); }
  void Handle(const Message& message, Outbox& out) override;
  std::vector<Count> Complaints() const override;

  const VoxelGrid& grid() const { return map_.grid(); }

 private:
  bool Accepts(const Stripe& stripe);
  void Publish(const Stripe& stripe, Outbox& out);

  int points_;
  MapUpdate map_;
  int32_t scan_ = -1;
  int32_t last_index_ = -1;  ///< Of the last stripe of the scan.
  bool scan_closed_ = false;
  int stripes_since_delta_ = 0;
  int64_t bad_ranges_ = 0;
  int64_t bad_poses_ = 0;
  int64_t out_of_order_ = 0;
};

}  // namespace nbs
