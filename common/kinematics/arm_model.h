#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/pose.h"

namespace nbs {

/// Arms have at most this many joints, so that joint values need no memory of their own.
inline constexpr int kMaxJoints = 8;

/// Joint values, radians, from base to flange.
using Joints = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

/// The same values as a vector.
///
/// @throws std::invalid_argument if there are more than kMaxJoints.
Joints MakeJoints(std::span<const double> values_rad);

/// All points within `radius_m` of the straight line from A to B; a sphere where A equals B. Metres, in the frame of
/// its link.
struct Capsule {
  Eigen::Vector3d p_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// A box: its middle and axes C in the frame of its link, half of its sizes along them, metres.
struct Block {
  Pose X_LC = Pose::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
};

/// What moves as one: a link of the chain with everything that fixed joints attach to it.
struct ArmLink {
  std::string name;
  std::vector<Capsule> capsules;
  std::vector<Block> blocks;
};

/// A turning joint. The frame of its link is X_PJ * Rotation(axis, q) in the frame of the link before.
struct ArmJoint {
  std::string name;
  Pose X_PJ = Pose::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Unit length.
  double min_rad = 0.0;
  double max_rad = 0.0;
  double max_rad_per_s = 0.0;
};

/// A serial arm from its base frame B to its flange frame F.
struct ArmModel {
  std::string name;
  std::vector<ArmJoint> joints;
  std::vector<ArmLink> links;    ///< One more than joints: link 0 is the base, link k moves with joint k - 1.
  Pose X_LF = Pose::Identity();  ///< The flange in the last link.

  int n() const { return static_cast<int>(joints.size()); }
};

/// Poses of all links in the base frame.
using LinkPoses = std::array<Pose, kMaxJoints + 1>;

/// @pre q has model.n() values.
void CalcLinkPoses(const ArmModel& model, const Joints& q, LinkPoses& X_BL);

/// X_BF.
Pose CalcFlangePose(const ArmModel& model, const Joints& q);

/// Velocity of the flange per joint speed: rows 0 to 2 turn (rad/s), rows 3 to 5 move its origin (m/s), in B.
Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints> CalcJacobian(const ArmModel& model, const Joints& q);

/// True if every joint lies in its range, widened by `tolerance_rad`.
bool IsWithinLimits(const ArmModel& model, const Joints& q, double tolerance_rad = 0.0);

/// Every q that differs from the given one by whole turns of joints and lies within the limits, in rising order (the
/// first joint first). Empty if there is none.
std::vector<Joints> FindTurns(const ArmModel& model, const Joints& q);

}  // namespace nbs
