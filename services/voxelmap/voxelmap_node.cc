#include "services/voxelmap/voxelmap_node.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nbs {

VoxelmapNode::VoxelmapNode(const RunConfig& config, const InverseSensorModelSettings& settings)
    : points_(config.cell.profiler.points), map_(config.grid, config.cell.profiler, settings) {}

void VoxelmapNode::Handle(const Message& message, Outbox& out) {
  const Stripe& stripe = std::get<Stripe>(message);
  if (!Accepts(stripe)) return;
  if (!stripe.end_of_scan) {
    map_.Insert(stripe);
    ++stripes_since_delta_;
  }
  if (stripe.end_of_scan || stripes_since_delta_ == kStripesPerDelta) Publish(stripe, out);
}

std::vector<Node::Count> VoxelmapNode::Complaints() const {
  return {{"bad_ranges", bad_ranges_}, {"bad_poses", bad_poses_}, {"out_of_order", out_of_order_}};
}

bool VoxelmapNode::Accepts(const Stripe& stripe) {
  const bool same_scan = stripe.scan == scan_;
  const bool stale = stripe.scan < scan_ || (same_scan && scan_closed_);
  const bool repeated = same_scan && !stripe.end_of_scan && stripe.index <= last_index_;
  if (stale || repeated) {
    ++out_of_order_;
    return false;
  }
  if (!stripe.end_of_scan) {
    const bool right_count = static_cast<int>(stripe.ranges_m.size()) == points_;
    if (!right_count ||
        !std::ranges::all_of(stripe.ranges_m, [](float range) { return std::isfinite(range) && range >= 0.0F; })) {
      ++bad_ranges_;
      return false;
    }
    if (!IsRigid(stripe.X_WS)) {
      ++bad_poses_;
      return false;
    }
  }
  scan_ = stripe.scan;
  last_index_ = stripe.index;
  scan_closed_ = stripe.end_of_scan;
  return true;
}

void VoxelmapNode::Publish(const Stripe& stripe, Outbox& out) {
  VoxelDelta delta = map_.TakeDelta();
  delta.utime_us = stripe.utime_us;
  delta.scan = stripe.scan;
  delta.end_of_scan = stripe.end_of_scan;
  stripes_since_delta_ = 0;
  out.push_back(std::move(delta));
}

}  // namespace nbs
