#include "common/kinematics/arm_model.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/common/kinematics/arms.h"

namespace nbs {
namespace {

Joints FromDegrees(std::initializer_list<double> degrees) {
  Joints q(static_cast<Eigen::Index>(degrees.size()));
  int k = 0;
  for (const double degree : degrees) q[k++] = degree * std::numbers::pi / 180.0;
  return q;
}

TEST(ArmModel, JointValuesAreTakenUpToTheMostThatAnArmHas) {
  const std::vector<double> values = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  const Joints q = MakeJoints(std::span(values).first(8));
  ASSERT_EQ(q.size(), 8);
  EXPECT_EQ(q[7], 0.8);
  EXPECT_THROW(MakeJoints(values), std::invalid_argument);
}

struct CheckPose {
  Joints q;
  Eigen::Vector3d p;
  Eigen::Vector3d z;
};

TEST(ArmModel, Kr16StandsAtItsCheckPoses) {
  const ArmModel model = ReadKr16();
  const CheckPose poses[] = {{FromDegrees({0, 0, 0, 0, 0, 0}), {1.768, 0, 0.640}, {1, 0, 0}},
                             {FromDegrees({0, -90, 90, 0, 0, 0}), {1.088, 0, 1.320}, {1, 0, 0}},
                             {FromDegrees({0, -90, 90, 0, 90, 0}), {0.930, 0, 1.162}, {0, 0, -1}}};
  for (const CheckPose& pose : poses) {
    const Pose X_BF = CalcFlangePose(model, pose.q);
    EXPECT_LT((X_BF.translation() - pose.p).norm(), 1e-12) << pose.q.transpose();
    EXPECT_LT((X_BF.linear().col(2) - pose.z).norm(), 1e-12) << pose.q.transpose();
  }
}

TEST(ArmModel, Kr16HasTheLimitsAndSpeedsOfItsDataSheet) {
  const ArmModel model = ReadKr16();
  ASSERT_EQ(model.n(), 6);
  const double min_deg[] = {-185, -155, -130, -350, -130, -350};
  const double max_deg[] = {185, 35, 154, 350, 130, 350};
  const double speed_deg[] = {156, 156, 156, 330, 330, 615};
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(model.joints[k].min_rad, min_deg[k] * std::numbers::pi / 180.0, 1e-12);
    EXPECT_NEAR(model.joints[k].max_rad, max_deg[k] * std::numbers::pi / 180.0, 1e-12);
    EXPECT_NEAR(model.joints[k].max_rad_per_s, speed_deg[k] * std::numbers::pi / 180.0, 1e-12);
  }
}

TEST(ArmModel, JacobianIsTheDerivativeOfTheFlangePose) {
  for (const ArmModel& model : {ReadKr16(), ReadTestArm("ur5.urdf", "base")}) {
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 20; ++i) {
      const Joints q = MakeRandomJoints(model, 6, i);
      const auto J = CalcJacobian(model, q);
      const Pose X_BF = CalcFlangePose(model, q);
      for (int k = 0; k < model.n(); ++k) {
        Joints moved = q;
        moved[k] += kStep;
        const Pose X_BF_moved = CalcFlangePose(model, moved);
        const Eigen::Vector3d velocity = (X_BF_moved.translation() - X_BF.translation()) / kStep;
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_BF_moved.linear() * X_BF.linear().transpose()));
        EXPECT_LT((velocity - J.col(k).tail<3>()).norm(), 1e-5);
        EXPECT_LT((turn.angle() * turn.axis() / kStep - J.col(k).head<3>()).norm(), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace nbs
