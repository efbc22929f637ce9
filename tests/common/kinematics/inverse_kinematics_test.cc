#include "common/kinematics/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/common/kinematics/arms.h"

namespace nbs {
namespace {

using std::numbers::pi;

constexpr double kSame_rad = 1e-5;  // near a stretched elbow, joints move a lot for little
constexpr int kPoses = 10000;

bool Contains(const std::vector<Joints>& solutions, const Joints& q) {
  return std::any_of(solutions.begin(), solutions.end(),
                     [&](const Joints& other) { return (q - other).cwiseAbs().maxCoeff() < kSame_rad; });
}

/// For random joint values: the pose's solutions hold them, and each puts the flange there.
void ExpectAllFound(const ArmModel& model) {
  const InverseKinematics ik(model, IkMethod::kAnalytic);
  for (int i = 0; i < kPoses; ++i) {
    const Joints q = MakeRandomJoints(model, 1, i);
    const Pose X_BF = CalcFlangePose(model, q);
    const std::vector<Joints> solutions = ik.FindAll(X_BF);
    ASSERT_TRUE(Contains(solutions, q)) << i << ": " << q.transpose();
    for (const Joints& solution : solutions) {
      ASSERT_TRUE(IsWithinLimits(model, solution));
      const Pose X_BF_again = CalcFlangePose(model, solution);
      ASSERT_LT((X_BF_again.translation() - X_BF.translation()).norm(), 1e-9) << i;
      ASSERT_LT((X_BF_again.linear() - X_BF.linear()).cwiseAbs().maxCoeff(), 1e-9) << i;
    }
  }
}

TEST(InverseKinematics, AllSolutionsOfTheKr16AreFoundAndExact) { ExpectAllFound(ReadKr16()); }

TEST(InverseKinematics, AllSolutionsOfAnotherArmAreFoundAndExact) {
  ExpectAllFound(ReadTestArm("irb120.urdf", "base"));
}

TEST(InverseKinematics, SolutionsAreWhatARandomSearchFinds) {
  // The numeric method knows nothing of shoulders, elbows and wrists.
  const ArmModel model = ReadKr16();
  const InverseKinematics ik(model, IkMethod::kAnalytic);
  const InverseKinematics search(model, IkMethod::kNumeric);
  size_t found = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose X_BF = CalcFlangePose(model, MakeRandomJoints(model, 2, i));
    const std::vector<Joints> solutions = ik.FindAll(X_BF);
    const std::vector<Joints> searched = search.FindAll(X_BF);
    for (const Joints& q : searched) ASSERT_TRUE(Contains(solutions, q)) << i << ": " << q.transpose();
    found += searched.size();
  }
  EXPECT_GT(found, 400u);
}

TEST(InverseKinematics, NoTwoSolutionsAreTheSame) {
  const ArmModel model = ReadKr16();
  const InverseKinematics ik(model, IkMethod::kAnalytic);
  for (int i = 0; i < 500; ++i) {
    const std::vector<Joints> solutions = ik.FindAll(CalcFlangePose(model, MakeRandomJoints(model, 3, i)));
    for (size_t a = 0; a < solutions.size(); ++a) {
      for (size_t b = 0; b < a; ++b) ASSERT_GT((solutions[a] - solutions[b]).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST(InverseKinematics, LengthsAreReadOffTheChain) {
  const SphericalWristIk::Lengths lengths = SphericalWristIk(ReadKr16()).lengths();
  EXPECT_NEAR(lengths.shoulder_radius, 0.260, 1e-12);
  EXPECT_NEAR(lengths.shoulder_height, 0.675, 1e-12);
  EXPECT_NEAR(lengths.offset, 0.0, 1e-12);
  EXPECT_NEAR(lengths.upper_arm, 0.680, 1e-12);
  EXPECT_NEAR(lengths.forearm, std::hypot(0.670, 0.035), 1e-12);
  EXPECT_NEAR(lengths.flange, 0.158, 1e-12);
}

TEST(InverseKinematics, OutOfReachHasNoSolution) {
  const ArmModel model = ReadKr16();
  const InverseKinematics ik(model, IkMethod::kAnalytic);
  const Pose X_BF = MakePose({2.5, 0, 1}, Eigen::Quaterniond::Identity());
  EXPECT_TRUE(ik.FindAll(X_BF).empty());
  EXPECT_FALSE(ik.IsInReach(X_BF));
}

TEST(InverseKinematics, StraightWristTakesItsFourthJointFromTheHint) {
  const ArmModel model = ReadKr16();
  const InverseKinematics ik(model, IkMethod::kAnalytic);
  Joints q(6);
  q << 0.1, -1.2, 1.4, 0.7, 0.0, -0.2;
  const std::vector<Joints> near = {q};
  EXPECT_TRUE(Contains(ik.FindAll(CalcFlangePose(model, q), near), q));
}

TEST(InverseKinematics, TurnsOfJointsWithinTheLimitsAreAllListed) {
  const ArmModel model = ReadKr16();
  Joints q(6);
  q << 3.13, -1, 1, 0.5, 1, -6.0;
  // A1 up to 185 degrees: 3.13 and 3.13 - 2 pi; A4 and A6 up to 350 degrees: 0.5 and 0.5 - 2 pi, -6 and -6 + 2 pi.
  EXPECT_EQ(FindTurns(model, q).size(), 8u);
  for (const Joints& turned : FindTurns(model, q)) EXPECT_TRUE(IsWithinLimits(model, turned));
}

TEST(InverseKinematics, ArmWithoutSphericalWristIsNamed) {
  const std::optional<std::string> obstacle = SphericalWristIk::FindObstacle(ReadTestArm("ur5.urdf", "base"));
  ASSERT_TRUE(obstacle);
  EXPECT_EQ(*obstacle,
            "has no spherical wrist: the axes of joints `wrist_1`, `wrist_2` and `wrist_3` do not meet in one point");
  EXPECT_THROW(InverseKinematics(ReadTestArm("ur5.urdf", "base"), IkMethod::kAnalytic), std::invalid_argument);
}

TEST(InverseKinematics, NumericMethodSolvesAnArmWithoutSphericalWrist) {
  const ArmModel model = ReadTestArm("ur5.urdf", "base");
  const InverseKinematics ik(model, IkMethod::kNumeric);
  int solved = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose X_BF = CalcFlangePose(model, MakeRandomJoints(model, 4, i));
    const std::vector<Joints> solutions = ik.FindAll(X_BF);
    solved += solutions.empty() ? 0 : 1;
    for (const Joints& q : solutions) {
      ASSERT_TRUE(IsWithinLimits(model, q));
      ASSERT_LT((CalcFlangePose(model, q).translation() - X_BF.translation()).norm(), 1e-9);
    }
  }
  EXPECT_GE(solved, 198);
}

TEST(InverseKinematics, NumericMethodComesBackToANearPose) {
  const ArmModel model = ReadTestArm("ur5.urdf", "base");
  const Joints q = MakeRandomJoints(model, 5, 0);
  const Joints start = q + Joints::Constant(6, 0.02);
  const std::optional<Joints> found = FindJointsNear(model, CalcFlangePose(model, q), start);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - q).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace nbs
