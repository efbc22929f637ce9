#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry/pose.h"
#include "common/planning/scan_path.h"

namespace nbs {

/// The robot's last two states of one scan, and the pose between them.
///
/// The profiler has its own clock: a profile may fall between two states. The flange then stands where a straight, even
/// motion from the one to the other puts it; at the time of a state it stands exactly where the state says.
class PoseTrack {
 public:
  /// Adds a state. The first state of another scan forgets the states before it: what the robot did between two scans
  /// is not known.
  void Add(const RobotState& state);

  /// Flange in world at `utime_us`; nullopt outside of the last two states.
  std::optional<Pose> FindPose(int64_t utime_us) const;

  /// The last state added; nullopt before the first.
  const std::optional<RobotState>& latest() const { return latest_; }

 private:
  std::optional<RobotState> previous_;
  std::optional<RobotState> latest_;
};

}  // namespace nbs
