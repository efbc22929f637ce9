#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/run_config.h"
#include "common/geometry/triangle_mesh.h"
#include "sim/robot_body.h"

namespace nbs {

/// What must not happen in a motion.
enum class MotionFault : uint8_t {
  kContactObject = 0,  ///< A body of the robot meets the true object.
  kContactTable = 1,
  kContactFloor = 2,
  kContactSelf = 3,  ///< Two parts of the arm meet, or one and the sensor.
  kJointLimit = 4,   ///< A joint is beyond its limits.
  kSpeed = 5,        ///< A joint turns, or flange or scanning sensor move, faster than they may.
  kJump = 6,         ///< The robot is where it cannot have come in the time.
};
inline constexpr int kMotionFaults = 7;

/// contact_object, contact_table, contact_floor, contact_self, joint_limit, speed, jump.
std::string_view ToString(MotionFault fault);

/// Where something was seen.
struct MotionPlace {
  int32_t scan = 0;
  int64_t utime_us = 0;  ///< Robot time since the start of the run.
  std::string body;      ///< A link, a joint, "sensor" or "flange"; two of them for a contact of the arm with itself.
};

struct MotionFaultCount {
  int64_t count = 0;                 ///< States of contact or beyond a limit; stretches between two states.
  std::optional<MotionPlace> first;  ///< Present if there is one.
};

/// What the executed motions of a run did, by the truth.
struct MotionAudit {
  int64_t states = 0;    ///< Looked at.
  int64_t contacts = 0;  ///< Of them those with a contact of any kind.
  std::array<MotionFaultCount, kMotionFaults> faults;
  double nearest_m = 0.0;              ///< Smallest distance of any body from the true object, at most kAuditReach_m.
  std::optional<MotionPlace> nearest;  ///< Where; none if nothing came within that reach.
  double move_s = 0.0;                 ///< Robot time between scan paths.
  double scan_s = 0.0;                 ///< Robot time on scan paths.

  const MotionFaultCount& of(MotionFault fault) const { return faults[static_cast<size_t>(fault)]; }
  int64_t CountAll() const;
};

inline constexpr double kAuditReach_m = 0.5;

/// What a robot did about one trajectory.
struct ExecutedMotion {
  Trajectory trajectory;           ///< As it was sent to the robot.
  std::vector<RobotState> states;  ///< As the robot reported them.
  bool done = false;               ///< False: it was refused, and the states alone count.
};

/// Looks at executed motions with the truth at hand.
///
/// A motion is what the robot reported and, in between, what it was told: both together, in the order of time, so a
/// robot that is not where its trajectory says shows as a jump. States are looked at so densely that no point of the
/// robot moves by more than 10 mm from one to the next.
///
/// A contact is one of the collision bodies, as the URDF and the cell give them, at the robot's true place: the joints
/// are where they report to be, and every part that moves stands off by as much as the flange truly does at that
/// instant (sim/pose_error.h), although the error of a real arm grows only along the way to the flange. The object is
/// its true mesh, the table solid down to the floor. A body wholly inside the object counts as touching it. Between its
/// own parts an arm stands as its joints say.
///
/// Joints may exceed their speed by 1 %, as may flange and sensor. A jump is more than twice as far as top speed allows
/// in the time, and farther than in a period of the profiler; it is no speed fault as well.
class MotionAuditor {
 public:
  /// @param object_W  The true object.
  /// @throws ConfigError if the URDF of an arm cannot be used.
  MotionAuditor(const TriangleMesh& object_W, const RunConfig& config);
  ~MotionAuditor();
  MotionAuditor(MotionAuditor&&) noexcept;

  /// Looks at the motion that follows those looked at before.
  ///
  /// @throws std::invalid_argument if a state or point of an arm has not a value for each of its joints.
  void Look(const ExecutedMotion& motion);

  const MotionAudit& audit() const { return audit_; }

 private:
  struct World;

  void LookAtState(const Posture& posture, int32_t scan);
  void LookAtStretch(const Posture& from, const Posture& to, int32_t scan);
  void Count(MotionFault fault, const MotionPlace& place);

  std::unique_ptr<const World> world_;
  std::optional<Posture> last_;  ///< Where the robot is.
  MotionAudit audit_;
};

}  // namespace nbs
