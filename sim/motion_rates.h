#pragma once

#include <optional>
#include <string>

#include "sim/motion_audit.h"
#include "sim/robot_body.h"

namespace nbs {

/// A joint that is beyond its limits; the first one, and none for a free-flying sensor.
std::optional<std::string> FindJointFault(const RobotBody& robot, const Posture& posture);

/// What is wrong with the way from one posture to the next.
struct RateFault {
  MotionFault kind = MotionFault::kSpeed;  ///< Or kJump.
  std::string body;                        ///< A joint, "flange" or "sensor".
};

/// The first joint, or else flange or scanning sensor, that comes farther than it may in the time; one that jumps goes
/// before one that is only too fast. What "may" means is said at MotionAuditor.
std::optional<RateFault> FindRateFault(const RobotBody& robot, const CellConfig& cell, const Posture& from,
                                       const Posture& to);

}  // namespace nbs
