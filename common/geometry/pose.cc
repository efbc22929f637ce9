#include "common/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nbs {

bool IsRigid(const Pose& X, double tolerance) {
  if (!X.matrix().allFinite()) return false;
  const Eigen::Matrix3d R = X.linear();
  const bool orthonormal = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= tolerance;
  return orthonormal && R.determinant() > 0.0;
}

Pose MakePose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& rotation) {
  Pose X = Pose::Identity();
  X.linear() = rotation.normalized().toRotationMatrix();
  X.translation() = position_m;
  return X;
}

Pose Interpolate(const Pose& X_WA, const Pose& X_WB, double fraction) {
  const Eigen::Quaterniond q_A(X_WA.linear());
  const Eigen::Quaterniond q_B(X_WB.linear());
  const Eigen::Vector3d p = X_WA.translation() + fraction * (X_WB.translation() - X_WA.translation());
  return MakePose(p, q_A.slerp(fraction, q_B));
}

double CalcAngleBetween(const Pose& X_WA, const Pose& X_WB) {
  return Eigen::Quaterniond(X_WA.linear()).angularDistance(Eigen::Quaterniond(X_WB.linear()));
}

Pose MakeLookPose(const Eigen::Vector3d& p_WS, const Eigen::Vector3d& view_W, const Eigen::Vector3d& scan_W) {
  if (view_W.norm() < 1e-9 || scan_W.norm() < 1e-9)
    throw std::invalid_argument("MakeLookPose: a direction of length 0");
  const Eigen::Vector3d z = view_W.normalized();
  const Eigen::Vector3d y_raw = scan_W.normalized() - z * z.dot(scan_W.normalized());
  if (y_raw.norm() < 1e-6) throw std::invalid_argument("MakeLookPose: viewing and scan direction are parallel");
  const Eigen::Vector3d y = y_raw.normalized();
  Pose X_WS = Pose::Identity();
  X_WS.linear().col(0) = y.cross(z);
  X_WS.linear().col(1) = y;
  X_WS.linear().col(2) = z;
  X_WS.translation() = p_WS;
  return X_WS;
}

}  // namespace nbs
