#include "common/kinematics/spherical_wrist_ik.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace nbs {
namespace {

using Complex = std::complex<double>;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kSameAngle = 1e-6;  // sine
constexpr double kSamePlace_m = 1e-6;
constexpr double kSingularSine = 1e-9;
/// What rounding may put a pose beyond the reach, as a share of the arm's length squared.
constexpr double kReachTolerance = 1e-12;

/// Axes of all joints at q = 0: a point and a direction each, in B.
struct Axes {
  Vector3d p[6];
  Vector3d w[6];
};

Axes FindAxes(const ArmModel& model) {
  LinkPoses X_BL;
  CalcLinkPoses(model, Joints::Zero(model.n()), X_BL);
  Axes axes;
  for (int k = 0; k < 6; ++k) {
    axes.p[k] = X_BL[k + 1].translation();
    axes.w[k] = X_BL[k + 1].linear() * model.joints[k].axis;
  }
  return axes;
}

bool AreSquare(const Vector3d& a, const Vector3d& b) { return std::abs(a.dot(b)) < kSameAngle; }
bool AreParallel(const Vector3d& a, const Vector3d& b) { return a.cross(b).norm() < kSameAngle; }

double CalcDistance(const Vector3d& p, const Vector3d& p_axis, const Vector3d& w_axis) {
  return (p - p_axis).cross(w_axis).norm();
}

/// Where axis 4 and axis 5, at right angles to each other, come nearest: a point of axis 4.
Vector3d FindWristMiddle(const Axes& axes) { return axes.p[3] + axes.w[3] * axes.w[3].dot(axes.p[4] - axes.p[3]); }

double WrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

Complex ToComplex(const Vector2d& v) { return {v.x(), v.y()}; }

}  // namespace

std::optional<std::string> SphericalWristIk::FindObstacle(const ArmModel& model) {
  if (model.n() != 6) return "has " + std::to_string(model.n()) + " moving joints instead of six";
  const Axes a = FindAxes(model);
  const auto name = [&](int k) { return "`" + model.joints[k].name + "`"; };
  if (!AreSquare(a.w[0], a.w[1])) return "has joint " + name(1) + " not at right angles to joint " + name(0);
  if (!AreParallel(a.w[1], a.w[2])) return "has joint " + name(2) + " not parallel to joint " + name(1);
  const std::string no_wrist =
      "has no spherical wrist: the axes of joints " + name(3) + ", " + name(4) + " and " + name(5);
  if (!AreSquare(a.w[3], a.w[4]) || !AreSquare(a.w[4], a.w[5]))
    return no_wrist + " are not at right angles one after the other";
  const Vector3d p_BC = FindWristMiddle(a);
  if (CalcDistance(p_BC, a.p[4], a.w[4]) > kSamePlace_m || CalcDistance(p_BC, a.p[5], a.w[5]) > kSamePlace_m)
    return no_wrist + " do not meet in one point";
  if (CalcDistance(a.p[2], a.p[1], a.w[1]) < kSamePlace_m || CalcDistance(p_BC, a.p[2], a.w[2]) < kSamePlace_m)
    return "has an arm without length between joint " + name(1) + " and its wrist";
  return std::nullopt;
}

SphericalWristIk::SphericalWristIk(const ArmModel& model) {
  if (const auto obstacle = FindObstacle(model)) throw std::invalid_argument("SphericalWristIk: the arm " + *obstacle);
  const Axes a = FindAxes(model);
  for (int k = 0; k < 6; ++k) w_[k] = a.w[k];
  R_BA_.col(2) = a.w[0];
  R_BA_.col(1) = (a.w[1] - a.w[0] * a.w[0].dot(a.w[1])).normalized();
  R_BA_.col(0) = R_BA_.col(1).cross(R_BA_.col(2));
  p_BA_ = a.p[0] - a.w[0] * a.w[0].dot(a.p[0]);
  const auto in_plane = [&](const Vector3d& p_B) -> Vector2d {
    const Vector3d p_A = R_BA_.transpose() * (p_B - p_BA_);
    return {p_A.z(), p_A.x()};
  };
  const Vector3d p_BC = FindWristMiddle(a);
  shoulder_ = in_plane(a.p[1]);
  upper_arm_ = in_plane(a.p[2]) - shoulder_;
  forearm_ = in_plane(p_BC) - in_plane(a.p[2]);
  offset_ = R_BA_.col(1).dot(p_BC - p_BA_);
  sign3_ = a.w[1].dot(a.w[2]) > 0.0 ? 1.0 : -1.0;
  wrist_angle_ = std::atan2(a.w[5].dot(a.w[4].cross(a.w[3])), a.w[5].dot(a.w[3]));
  const Pose X_BF = CalcFlangePose(model, Joints::Zero(6));
  R_BF_zero_ = X_BF.linear();
  p_FC_ = X_BF.inverse() * p_BC;
}

std::vector<SphericalWristIk::Arm> SphericalWristIk::SolveArm(const Vector3d& p_BC) const {
  std::vector<Arm> arms;
  const Vector3d p_AC = R_BA_.transpose() * (p_BC - p_BA_);
  const double length = shoulder_.norm() + upper_arm_.norm() + forearm_.norm();
  const double forward2 = p_AC.head<2>().squaredNorm() - offset_ * offset_;
  if (forward2 < -kReachTolerance * length * length) return arms;
  const Complex upper = ToComplex(upper_arm_);
  const Complex fore = ToComplex(forearm_);
  for (const double side : {1.0, -1.0}) {
    const double forward = side * std::sqrt(std::max(0.0, forward2));
    const double q1 = std::atan2(p_AC.y(), p_AC.x()) - std::atan2(offset_, forward);
    // In the plane (z, x), a turn about y by q multiplies by e^(iq).
    const Complex reach = Complex(p_AC.z(), forward) - ToComplex(shoulder_);
    const double product = 2.0 * std::abs(upper) * std::abs(fore);
    const double cosine = (std::norm(reach) - std::norm(upper) - std::norm(fore)) / product;
    if (std::abs(cosine) > 1.0 + kReachTolerance * length * length / product) continue;
    const double bend = std::acos(std::clamp(cosine, -1.0, 1.0));
    for (const double elbow : {1.0, -1.0}) {
      const double q3 = elbow * bend - std::arg(fore) + std::arg(upper);
      const double q2 = std::arg(reach) - std::arg(upper + std::polar(1.0, q3) * fore);
      arms.push_back({{q1, q2, sign3_ * q3}});
    }
  }
  return arms;
}

void SphericalWristIk::SolveWrist(const Arm& arm, const Matrix3d& R_BF, double q4_singular,
                                  std::vector<Joints>& found) const {
  Matrix3d R_arm = Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) R_arm *= Eigen::AngleAxisd(arm.q[k], w_[k]).toRotationMatrix();
  // What the wrist must turn: R = Rot(w4, q4) Rot(w5, q5) Rot(w6, q6).
  const Matrix3d R = R_arm.transpose() * R_BF * R_BF_zero_.transpose();
  const Vector3d side = w_[4].cross(w_[3]);
  const Vector3d axis6 = R * w_[5];
  const double along = axis6.dot(w_[3]);
  const Vector3d across = axis6 - along * w_[3];
  const double sine = across.norm();
  for (const double flip : {1.0, -1.0}) {
    const double angle5 = std::atan2(flip * sine, along);
    const double q4 =
        sine < kSingularSine ? q4_singular : std::atan2(flip * across.dot(w_[4]), flip * across.dot(side));
    const double q5 = angle5 - wrist_angle_;
    const Matrix3d R_45 =
        Eigen::AngleAxisd(q4, w_[3]).toRotationMatrix() * Eigen::AngleAxisd(q5, w_[4]).toRotationMatrix();
    const Vector3d turned = R_45.transpose() * (R * w_[4]);
    const double q6 = std::atan2(turned.dot(w_[5].cross(w_[4])), turned.dot(w_[4]));
    Joints q(6);
    q << arm.q[0], arm.q[1], arm.q[2], q4, q5, q6;
    found.push_back(q.unaryExpr(&WrapAngle));
  }
}

std::vector<Joints> SphericalWristIk::Solve(const Pose& X_BF, double q4_singular) const {
  std::vector<Joints> found;
  found.reserve(8);
  for (const Arm& arm : SolveArm(X_BF * p_FC_)) SolveWrist(arm, X_BF.linear(), q4_singular, found);
  return found;
}

SphericalWristIk::Lengths SphericalWristIk::lengths() const {
  return {std::abs(shoulder_.y()), std::abs(shoulder_.x() + R_BA_.col(2).dot(p_BA_)),
          std::abs(offset_),       upper_arm_.norm(),
          forearm_.norm(),         p_FC_.norm()};
}

}  // namespace nbs
