#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "common/kinematics/arm_body.h"

namespace nbs {

/// Where a robot is at one instant.
struct Posture {
  int64_t utime_us = 0;
  Pose X_WF = Pose::Identity();  ///< As the robot reports it.
  Joints q;                      ///< Empty for a free-flying sensor.
  bool scanning = false;
};

/// A rigid part of a robot, placed in W.
struct PlacedPart {
  std::string name;  ///< Of its link in the URDF, or "sensor".
  int link = 0;      ///< 0: stands on the floor and never moves.
  std::vector<Capsule> capsules_W;
  std::vector<Block> blocks_W;
};

/// The collision bodies of a run's robot, each exactly as its URDF says, and those of the sensor as the cell says.
class RobotBody {
 public:
  /// @throws ConfigError if the URDF of an arm cannot be used.
  explicit RobotBody(const RunConfig& config);

  const std::optional<ArmModel>& arm() const { return arm_; }

  /// The base of an arm in W.
  const Pose& X_WB() const { return X_WB_; }

  /// An arm's posture at the joint values given; its flange follows from them.
  ///
  /// @throws std::invalid_argument if there is not a value for each joint.
  Posture MakePosture(int64_t utime_us, const Joints& q, bool scanning) const;

  /// Half-way and elsewhere between two postures: an arm moves its joints evenly, a sensor alone flies straight.
  Posture Interpolate(const Posture& from, const Posture& to, double share) const;

  /// Upper bound of how far any point of the robot moves from one posture to the other, metres.
  double CalcTravel(const Posture& from, const Posture& to) const;

  /// All parts.
  ///
  /// @param offset_W  Added to every part that moves: where the robot truly is, beside where it says that it is.
  std::vector<PlacedPart> Place(const Posture& posture, const Eigen::Vector3d& offset_W) const;

  /// Names of the two parts that are nearest to each other, if they overlap: "link_2 and sensor". Neighbours are not
  /// compared (common/kinematics/arm_body.h).
  std::optional<std::string> FindSelfContact(const Posture& posture) const;

 private:
  std::vector<Capsule> tool_F_;
  std::optional<ArmModel> arm_;
  std::optional<ArmBody> body_;
  Pose X_WB_ = Pose::Identity();
};

}  // namespace nbs
