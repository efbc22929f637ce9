#include "common/kinematics/inverse_kinematics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using std::numbers::pi;

constexpr uint64_t kStartsKey = 0x6e756d6572696b;  // "numerik"
constexpr int kStarts = 24;
constexpr int kStartsBeside = 8;
constexpr double kSameSolution_rad = 1e-6;

/// Turn and way, in B, from one pose of the flange to another.
Vector6d CalcError(const Pose& X_BF_from, const Pose& X_BF_to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_BF_to.linear() * X_BF_from.linear().transpose()));
  Vector6d error;
  error << turn.angle() * turn.axis(), X_BF_to.translation() - X_BF_from.translation();
  return error;
}

/// Whole turns taken off until each joint lies in its range, where that is possible.
Joints TurnIntoLimits(const ArmModel& model, Joints q) {
  for (int k = 0; k < model.n(); ++k) {
    const ArmJoint& joint = model.joints[k];
    if (q[k] > joint.max_rad) q[k] -= 2.0 * pi * std::ceil((q[k] - joint.max_rad) / (2.0 * pi));
    if (q[k] < joint.min_rad) q[k] += 2.0 * pi * std::ceil((joint.min_rad - q[k]) / (2.0 * pi));
  }
  return q;
}

}  // namespace

std::optional<Joints> FindJointsNear(const ArmModel& model, const Pose& X_BF, const Joints& q_start,
                                     const NumericIkSettings& settings) {
  Joints q = q_start;
  for (int i = 0; i < settings.iterations; ++i) {
    const Vector6d error = CalcError(CalcFlangePose(model, q), X_BF);
    if (error.head<3>().norm() <= settings.tolerance_m && error.tail<3>().norm() <= settings.tolerance_m) {
      q = TurnIntoLimits(model, q);
      return IsWithinLimits(model, q) ? std::optional(q) : std::nullopt;
    }
    const auto J = CalcJacobian(model, q);
    const double damping = std::min(1e-2, 1e-2 * error.squaredNorm());
    const Eigen::Matrix<double, 6, 6> A = J * J.transpose() + damping * Eigen::Matrix<double, 6, 6>::Identity();
    Joints step = Joints::Zero(model.n());
    step = J.transpose() * A.ldlt().solve(error);
    const double largest = step.cwiseAbs().maxCoeff();
    if (!std::isfinite(largest)) return std::nullopt;
    if (largest > settings.largest_step_rad) step *= settings.largest_step_rad / largest;
    q += step;
  }
  return std::nullopt;
}

InverseKinematics::InverseKinematics(const ArmModel& model, IkMethod method) : model_(model) {
  if (method == IkMethod::kAnalytic) analytic_.emplace(model);
}

bool InverseKinematics::IsInReach(const Pose& X_BF) const { return !analytic_ || !analytic_->Solve(X_BF).empty(); }

std::vector<Joints> InverseKinematics::FindAll(const Pose& X_BF, std::span<const Joints> near) const {
  std::vector<Joints> solutions;
  if (analytic_) {
    solutions = analytic_->Solve(X_BF, near.empty() ? 0.0 : near.front()[3]);
  } else {
    solutions = FindNumeric(X_BF, near);
  }
  std::vector<Joints> all;
  for (const Joints& q : solutions) {
    for (Joints& turned : FindTurns(model_, q)) all.push_back(std::move(turned));
  }
  return all;
}

std::vector<Joints> InverseKinematics::FindNumeric(const Pose& X_BF, std::span<const Joints> near) const {
  std::vector<Joints> starts(near.begin(), near.end());
  const int fixed = near.empty() ? kStarts : kStartsBeside;
  for (uint64_t start = 0; start < static_cast<uint64_t>(fixed); ++start) {
    Joints q(model_.n());
    for (int k = 0; k < model_.n(); ++k) {
      const double share = CalcUniform({kStartsKey, start, static_cast<uint64_t>(k)});
      q[k] = model_.joints[k].min_rad + share * (model_.joints[k].max_rad - model_.joints[k].min_rad);
    }
    starts.push_back(q);
  }
  std::vector<Joints> found;
  for (const Joints& start : starts) {
    const std::optional<Joints> q = FindJointsNear(model_, X_BF, start);
    if (!q) continue;
    // Solutions that differ by whole turns count as one; FindAll adds the turns.
    const bool known = std::any_of(found.begin(), found.end(), [&](const Joints& other) {
      return (*q - other).unaryExpr([](double d) { return std::abs(std::remainder(d, 2.0 * pi)); }).maxCoeff() <
             kSameSolution_rad;
    });
    if (!known) found.push_back(*q);
  }
  return found;
}

}  // namespace nbs
