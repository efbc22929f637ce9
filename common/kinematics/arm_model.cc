#include "common/kinematics/arm_model.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace nbs {

using std::numbers::pi;

Joints MakeJoints(std::span<const double> values_rad) {
  if (values_rad.size() > kMaxJoints)
    throw std::invalid_argument("MakeJoints: an arm has no " + std::to_string(values_rad.size()) + " joints");
  return Eigen::Map<const Eigen::VectorXd>(values_rad.data(), static_cast<Eigen::Index>(values_rad.size()));
}

void CalcLinkPoses(const ArmModel& model, const Joints& q, LinkPoses& X_BL) {
  X_BL[0] = Pose::Identity();
  for (int k = 0; k < model.n(); ++k) {
    const ArmJoint& joint = model.joints[k];
    X_BL[k + 1] = X_BL[k] * joint.X_PJ;
    X_BL[k + 1].linear() *= Eigen::AngleAxisd(q[k], joint.axis).toRotationMatrix();
  }
}

Pose CalcFlangePose(const ArmModel& model, const Joints& q) {
  LinkPoses X_BL;
  CalcLinkPoses(model, q, X_BL);
  return X_BL[model.n()] * model.X_LF;
}

Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints> CalcJacobian(const ArmModel& model, const Joints& q) {
  LinkPoses X_BL;
  CalcLinkPoses(model, q, X_BL);
  const Eigen::Vector3d p_BF = X_BL[model.n()] * model.X_LF.translation();
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints> J(6, model.n());
  for (int k = 0; k < model.n(); ++k) {
    const Eigen::Vector3d axis_B = X_BL[k + 1].linear() * model.joints[k].axis;
    J.col(k).head<3>() = axis_B;
    J.col(k).tail<3>() = axis_B.cross(p_BF - X_BL[k + 1].translation());
  }
  return J;
}

bool IsWithinLimits(const ArmModel& model, const Joints& q, double tolerance_rad) {
  for (int k = 0; k < model.n(); ++k) {
    if (!(q[k] >= model.joints[k].min_rad - tolerance_rad && q[k] <= model.joints[k].max_rad + tolerance_rad))
      return false;
  }
  return true;
}

std::vector<Joints> FindTurns(const ArmModel& model, const Joints& q) {
  std::vector<Joints> found = {q};
  for (int k = 0; k < model.n(); ++k) {
    const ArmJoint& joint = model.joints[k];
    const double first = q[k] + 2.0 * pi * std::ceil((joint.min_rad - q[k]) / (2.0 * pi));
    std::vector<Joints> grown;
    for (Joints turned : found) {
      for (turned[k] = first; turned[k] <= joint.max_rad; turned[k] += 2.0 * pi) grown.push_back(turned);
    }
    found = std::move(grown);
  }
  return found;
}

}  // namespace nbs
