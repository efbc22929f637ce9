#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/kinematics/arm_model.h"

namespace nbs {

/// Inverse kinematics in closed form of six-axis arms with an ortho-parallel basis and a spherical wrist: joint 2
/// stands at right angles to joint 1, joint 3 is parallel to joint 2, the axes of joints 4 to 6 meet in one point and
/// joint 5 stands at right angles to 4 and 6. Most industrial arms are of this kind.
///
/// After Brandstötter, Angerer, Hofbaur, "An analytical solution of the inverse kinematics problem of industrial serial
/// manipulators with an ortho-parallel basis and a spherical wrist", Austrian Robotics Workshop 2014. The parameters
/// are read off the chain itself, whatever its zero pose and the signs of its axes.
class SphericalWristIk {
 public:
  /// Why an arm is not of this kind, in words that follow its name ("joint `a5` …"); nullopt if it is.
  static std::optional<std::string> FindObstacle(const ArmModel& model);

  /// @throws std::invalid_argument if the arm is not of this kind.
  explicit SphericalWristIk(const ArmModel& model);

  /// All solutions, at most eight, each joint in (-pi, pi], whether or not within the limits: shoulder in front and
  /// back, elbow up and down, wrist and flipped wrist. Empty where the wrist's middle is out of reach.
  ///
  /// Where the axes of joints 4 and 6 fall together only their sum counts: joint 4 is then `q4_singular`.
  std::vector<Joints> Solve(const Pose& X_BF, double q4_singular = 0.0) const;

  /// Lengths as in the publication, metres, for a look at what was read off; signs depend on the zero pose.
  struct Lengths {
    double shoulder_radius = 0.0;  ///< a1: axis 1 to axis 2.
    double shoulder_height = 0.0;  ///< c1: along axis 1, from the base frame's origin.
    double offset = 0.0;           ///< b: of the wrist's middle from the plane of axis 1.
    double upper_arm = 0.0;        ///< c2: axis 2 to axis 3.
    double forearm = 0.0;          ///< sqrt(a2^2 + c3^2): axis 3 to the wrist's middle.
    double flange = 0.0;           ///< c4: the wrist's middle to the flange's origin.
  };
  Lengths lengths() const;

 private:
  struct Arm {
    double q[3];
  };
  std::vector<Arm> SolveArm(const Eigen::Vector3d& p_BC) const;
  void SolveWrist(const Arm& arm, const Eigen::Matrix3d& R_BF, double q4_singular, std::vector<Joints>& found) const;

  Eigen::Vector3d w_[6];  ///< Axes at q = 0, in B.
  Eigen::Matrix3d R_BA_;  ///< Columns: x forward, y along axis 2, z along axis 1.
  Eigen::Vector3d p_BA_;  ///< A point of axis 1.
  Eigen::Matrix3d R_BF_zero_;
  Eigen::Vector3d p_FC_;      ///< The wrist's middle in the flange.
  Eigen::Vector2d shoulder_;  ///< z and x in A, as are the two arms at q = 0.
  Eigen::Vector2d upper_arm_;
  Eigen::Vector2d forearm_;
  double offset_ = 0.0;
  double sign3_ = 1.0;
  double wrist_angle_ = 0.0;  ///< Angle about axis 5 from axis 4 to axis 6 at q = 0.
};

}  // namespace nbs
