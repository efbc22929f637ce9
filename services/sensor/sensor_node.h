#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/config/run_config.h"
#include "common/runtime/node.h"
#include "services/sensor/pose_track.h"

namespace nbs {

/// Puts each profile in its place in the world: PROFILE and ROBOT_STATE in, STRIPE out.
///
/// Reads a profile, then as many robot states as it takes to bracket the profile's time, and publishes a stripe with
/// the sensor's pose at that time and the ranges within the depth of field. The closing profile is answered, once the
/// robot's last state of the scan is read, by the closing stripe; so every scan that the robot closes is closed, even
/// without a single stripe. Stripes are numbered from 0 in each scan; a refused profile takes no number.
class SensorNode : public Node {
 public:
  explicit SensorNode(const RunConfig& config);

  size_t NextInput() const override;
  void Handle(const Message& message, Outbox& out) override;

  /// Refused profiles: profile_points (not one range a beam), profile_time (not later than the profile before),
  /// profile_without_pose (the robot told no pose for that time). Dropped ranges: range_out_of_depth, range_invalid
  /// (negative or not finite).
  std::vector<Count> Complaints() const override;

 private:
  void Receive(const Profile& profile);
  void PublishIfReady(Outbox& out);
  void PublishStripe(const Profile& profile, Outbox& out);
  void PublishClosing(const Profile& profile, Outbox& out);

  /// True from the robot's last state of a scan until the closing stripe.
  bool IsRobotDone() const;
  bool NeedsState() const;

  Profiler profiler_;
  Pose X_FS_;
  std::vector<Eigen::Vector3d> directions_S_;
  PoseTrack track_;
  std::optional<Profile> pending_;
  bool closed_ = true;  ///< The scan of the last robot state has its closing stripe.
  int32_t next_index_ = 0;
  int64_t last_profile_utime_us_ = std::numeric_limits<int64_t>::min();
  int64_t last_closing_utime_us_ = std::numeric_limits<int64_t>::min();
  int64_t last_stripe_utime_us_ = 0;
  int64_t profile_points_ = 0;
  int64_t profile_time_ = 0;
  int64_t profile_without_pose_ = 0;
  int64_t range_out_of_depth_ = 0;
  int64_t range_invalid_ = 0;
};

}  // namespace nbs
