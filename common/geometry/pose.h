#pragma once

#include <Eigen/Geometry>

namespace nbs {

/// Rigid transform. X_AB is the pose of frame B in frame A and maps p_B to p_A: p_A = X_AB * p_B.
/// Frames: W world, B robot base, F flange, S sensor, C the profiler's camera, O object.
using Pose = Eigen::Isometry3d;

/// True if X is finite and its linear part is a rotation (orthonormal, determinant +1) within `tolerance`.
bool IsRigid(const Pose& X, double tolerance = 1e-6);

/// Pose from a position in metres and a rotation.
Pose MakePose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& rotation);

/// Straight line between the origins, shortest rotation between the orientations (slerp).
///
/// @param fraction  0 gives X_WA, 1 gives X_WB; not clamped.
Pose Interpolate(const Pose& X_WA, const Pose& X_WB, double fraction);

/// Smallest angle, radians in [0, pi], that turns one orientation into the other.
double CalcAngleBetween(const Pose& X_WA, const Pose& X_WB);

/// Sensor pose at `p_WS` whose z axis (viewing direction) is `view_W` and whose y axis (scan direction) is as near to
/// `scan_W` as orthogonality allows. The x axis, along the stripe, follows: x = y cross z.
///
/// @throws std::invalid_argument if either direction is shorter than 1e-9 or they are parallel within 1e-6 rad.
Pose MakeLookPose(const Eigen::Vector3d& p_WS, const Eigen::Vector3d& view_W, const Eigen::Vector3d& scan_W);

}  // namespace nbs
