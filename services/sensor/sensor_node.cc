#include "services/sensor/sensor_node.h"

#include <algorithm>

#include "services/sensor/range_filter.h"

namespace nbs {

SensorNode::SensorNode(const RunConfig& config)
    : profiler_(config.cell.profiler),
      X_FS_(config.cell.X_FS),
      directions_S_(CalcBeamDirections_S(config.cell.profiler)) {}

size_t SensorNode::NextInput() const { return pending_ ? StreamOf<RobotState>() : StreamOf<Profile>(); }

void SensorNode::Handle(const Message& message, Outbox& out) {
  if (const auto* profile = std::get_if<Profile>(&message)) {
    Receive(*profile);
  } else {
    track_.Add(std::get<RobotState>(message));
    closed_ = false;
  }
  PublishIfReady(out);
}

void SensorNode::Receive(const Profile& profile) {
  const int64_t earlier_utime_us = profile.end_of_scan ? last_closing_utime_us_ : last_profile_utime_us_;
  if (profile.utime_us <= earlier_utime_us) {
    ++profile_time_;
    return;
  }
  last_profile_utime_us_ = std::max(last_profile_utime_us_, profile.utime_us);
  if (profile.end_of_scan) {
    last_closing_utime_us_ = profile.utime_us;
  } else if (profile.ranges_m.size() != directions_S_.size()) {
    ++profile_points_;
    return;
  }
  pending_ = profile;
}

bool SensorNode::IsRobotDone() const { return !closed_ && track_.latest()->end_of_scan; }

bool SensorNode::NeedsState() const {
  if (IsRobotDone()) return false;
  return pending_->end_of_scan || !track_.latest() || pending_->utime_us > track_.latest()->utime_us;
}

void SensorNode::PublishIfReady(Outbox& out) {
  if (!pending_ || NeedsState()) return;
  if (pending_->end_of_scan) {
    PublishClosing(*pending_, out);
  } else {
    PublishStripe(*pending_, out);
  }
  pending_.reset();
}

void SensorNode::PublishStripe(const Profile& profile, Outbox& out) {
  const std::optional<Pose> X_WF = closed_ ? std::nullopt : track_.FindPose(profile.utime_us);
  if (!X_WF) {
    ++profile_without_pose_;
    return;
  }
  FilteredRanges filtered = FilterRanges(profiler_, directions_S_, profile.ranges_m);
  range_out_of_depth_ += filtered.out_of_depth;
  range_invalid_ += filtered.not_a_range;
  last_stripe_utime_us_ = profile.utime_us;
  out.push_back(Stripe{profile.utime_us, track_.latest()->scan, next_index_++, false, *X_WF * X_FS_,
                       std::move(filtered.ranges_m)});
}

void SensorNode::PublishClosing(const Profile& profile, Outbox& out) {
  const RobotState& last = *track_.latest();
  last_stripe_utime_us_ = std::max(last_stripe_utime_us_, profile.utime_us);
  out.push_back(Stripe{last_stripe_utime_us_, last.scan, next_index_, true, last.X_WF * X_FS_, {}});
  next_index_ = 0;
  closed_ = true;
}

std::vector<Node::Count> SensorNode::Complaints() const {
  return {{"profile_points", profile_points_},
          {"profile_time", profile_time_},
          {"profile_without_pose", profile_without_pose_},
          {"range_out_of_depth", range_out_of_depth_},
          {"range_invalid", range_invalid_}};
}

}  // namespace nbs
