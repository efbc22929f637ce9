#include "services/sensor/pose_track.h"

namespace nbs {

void PoseTrack::Add(const RobotState& state) {
  const bool same_scan = latest_ && latest_->scan == state.scan;
  if (same_scan) {
    previous_ = std::move(latest_);
  } else {
    previous_.reset();
  }
  latest_ = state;
}

std::optional<Pose> PoseTrack::FindPose(int64_t utime_us) const {
  if (!latest_ || utime_us > latest_->utime_us) return std::nullopt;
  if (utime_us == latest_->utime_us) return latest_->X_WF;
  if (!previous_ || utime_us < previous_->utime_us) return std::nullopt;
  if (utime_us == previous_->utime_us) return previous_->X_WF;
  const auto span = static_cast<double>(latest_->utime_us - previous_->utime_us);
  return Interpolate(previous_->X_WF, latest_->X_WF, static_cast<double>(utime_us - previous_->utime_us) / span);
}

}  // namespace nbs
