#include "services/planner/motion_planning/arm_timing.h"

#include <gtest/gtest.h>

#include "tests/common/kinematics/arms.h"

namespace nbs {
namespace {

ArmTimingLimits MakeLimitsOf(const ArmModel& model) {
  ArmTimingLimits limits;
  for (const ArmJoint& joint : model.joints) limits.rad_per_s.push_back(joint.max_rad_per_s);
  limits.rad_per_s2 = {5, 5, 5, 10, 10, 15};
  limits.flange = {0.5, 1.5, 0.05, 40000};
  return limits;
}

class ArmTiming : public testing::Test {
 protected:
  Trajectory Make(std::vector<Joints> approach, double length_m = 0.2) const {
    std::vector<Joints> scan = {approach.back()};
    for (int k = 1; k <= 20; ++k) scan.push_back(approach.back() + Joints::Constant(6, 0.005 * k));
    return MakeArmTrajectory(model_, Pose::Identity(), limits_, approach, scan, length_m);
  }

  ArmModel model_ = ReadKr16();
  ArmTimingLimits limits_ = MakeLimitsOf(model_);
  std::vector<Joints> approach_ = {MakeRandomJoints(model_, 1, 0), MakeRandomJoints(model_, 1, 1),
                                   MakeRandomJoints(model_, 1, 2)};
};

/// Speeds and accelerations of all joints, and the flange's speed.
void ExpectKept(const ArmTimingLimits& limits, const std::vector<TrajectoryPoint>& points, bool in_the_scan = false) {
  Joints speed_before = Joints::Zero(6);
  double duration_before = 0.0;
  double fastest = 0.0;
  for (size_t i = 1; i < points.size(); ++i) {
    const double duration_s = 1e-6 * static_cast<double>(points[i].time_us - points[i - 1].time_us);
    ASSERT_GT(duration_s, 0.0);
    for (int k = 0; k < 6; ++k) {
      const double speed = (points[i].joints_rad[k] - points[i - 1].joints_rad[k]) / duration_s;
      EXPECT_LE(std::abs(speed), limits.rad_per_s[k] * 1.001);
      if (in_the_scan || !points[i - 1].scanning) {
        EXPECT_LE(std::abs(speed - speed_before[k]) / (0.5 * (duration_s + duration_before)),
                  limits.rad_per_s2[k] * (points[i - 1].scanning ? 1.04 : 1.01))
            << i;
      }
      speed_before[k] = speed;
      fastest = std::max(fastest, std::abs(speed) / limits.rad_per_s[k]);
    }
    duration_before = duration_s;
    EXPECT_LE((points[i].X_WF.translation() - points[i - 1].X_WF.translation()).norm() / duration_s, 0.5 * 1.01);
  }
  EXPECT_GT(fastest, 0.1);
}

TEST_F(ArmTiming, KeepsSpeedsAndAccelerationsOfAllJoints) { ExpectKept(limits_, Make(approach_).points); }

TEST_F(ArmTiming, AJointThatTurnsFastFromTheStartOfAScanGathersItsSpeedWithinItsLimit) {
  // Beside the wrist's singularity, where joints 4 and 6 turn against each other: 45 rad/m at first, 11 rad/s2 on the
  // usual ramp.
  approach_.back()[4] = 0.005;
  std::vector<Joints> scan = {approach_.back()};
  for (int k = 1; k <= 20; ++k)
    scan.push_back(scan.back() + Joints::Constant(6, 0.002) +
                   std::pow(0.7, k) * 0.64 * (Joints::Unit(6, 3) - Joints::Unit(6, 5)));
  const auto make = [&](const ArmTimingLimits& limits) {
    return MakeArmTrajectory(model_, Pose::Identity(), limits, approach_, scan, 0.2);
  };
  const Trajectory trajectory = make(limits_);
  ExpectKept(limits_, trajectory.points, true);
  EXPECT_LE(CalcAccelerationShare(trajectory, limits_.rad_per_s2), kMostAccelerationShare);
  ArmTimingLimits strong = limits_;
  strong.rad_per_s2[3] = 1e3;
  EXPECT_GT(CalcAccelerationShare(make(strong), limits_.rad_per_s2), 1.1);
  EXPECT_GT(trajectory.points.back().time_us, make(strong).points.back().time_us);
}

TEST_F(ArmTiming, SlowAccelerationsOnAWayOfManyLegsKeepTheLimitsInOneMessage) {
  limits_.rad_per_s2.assign(6, 0.5);
  std::vector<Joints> way;
  for (uint64_t k = 0; k < 9; ++k) way.push_back(MakeRandomJoints(model_, 2, k));
  const std::vector<TrajectoryPoint> points = Make(way).points;
  EXPECT_LE(points.size(), CalcMostPoints(6));
  EXPECT_GT(points.size(), CalcMostPoints(6) / 3) << "no coarser than needed";
  ExpectKept(limits_, points);
}

TEST_F(ArmTiming, PosesBelongToTheirJoints) {
  for (const TrajectoryPoint& point : Make(approach_).points) {
    const Joints q = Eigen::Map<const Eigen::VectorXd>(point.joints_rad.data(), 6);
    EXPECT_EQ(point.X_WF.matrix(), CalcFlangePose(model_, q).matrix());
  }
}

TEST_F(ArmTiming, ScanBeginsOnTheProfileClockAndTakesItsTime) {
  const std::vector<TrajectoryPoint> points = Make(approach_).points;
  const auto first = std::find_if(points.begin(), points.end(), [](const TrajectoryPoint& p) { return p.scanning; });
  ASSERT_NE(first, points.end());
  EXPECT_EQ(first->time_us % 40000, 0);
  // Whatever the length was said to be, the sensor is not faster than 50 mm/s.
  for (auto point = first; point + 1 != points.end(); ++point) {
    const double way_m = ((point + 1)->X_WF.translation() - point->X_WF.translation()).norm();
    EXPECT_LE(way_m, 0.05 * 1e-6 * static_cast<double>((point + 1)->time_us - point->time_us) + 1e-9);
  }
  EXPECT_FALSE(points.back().scanning);
  EXPECT_TRUE((points.end() - 2)->scanning);
}

TEST_F(ArmTiming, SensorIsNotTooFastBetweenThePointsEither) {
  std::vector<Joints> scan = {approach_.back()};
  for (const double turn : {0.1, -0.12, 0.14})
    scan.push_back(scan.back() + turn * Joints::Unit(6, 1) - 0.3 * Joints::Unit(6, 2));
  const std::vector<TrajectoryPoint> points =
      MakeArmTrajectory(model_, Pose::Identity(), limits_, {scan.data(), 1}, scan, 1.0).points;
  for (size_t i = 1; i < points.size(); ++i) {
    constexpr int kPieces = 50;
    const Joints q_from = Eigen::Map<const Eigen::VectorXd>(points[i - 1].joints_rad.data(), 6);
    const Joints q_to = Eigen::Map<const Eigen::VectorXd>(points[i].joints_rad.data(), 6);
    const double piece_s = 1e-6 * static_cast<double>(points[i].time_us - points[i - 1].time_us) / kPieces;
    Eigen::Vector3d p_last = points[i - 1].X_WF.translation();
    for (int k = 1; k <= kPieces; ++k) {
      const Joints q = q_from + (static_cast<double>(k) / kPieces) * (q_to - q_from);
      const Eigen::Vector3d p = CalcFlangePose(model_, q).translation();
      EXPECT_LE((p - p_last).norm(), 0.0505 * piece_s + 1e-9) << i;
      p_last = p;
    }
  }
}

TEST_F(ArmTiming, RestsAtEveryCornerOfTheApproach) {
  const std::vector<TrajectoryPoint> points = Make(approach_).points;
  const auto corner = std::find_if(points.begin(), points.end(), [&](const TrajectoryPoint& p) {
    return (Eigen::Map<const Eigen::VectorXd>(p.joints_rad.data(), 6) - approach_[1]).norm() == 0.0;
  });
  ASSERT_NE(corner, points.end());
  EXPECT_EQ(points.front().joints_rad, std::vector<double>(approach_[0].begin(), approach_[0].end()));
}

TEST_F(ArmTiming, PathWithoutLengthLastsOnePeriod) {
  const std::vector<Joints> rest = {approach_.back(), approach_.back()};
  const Trajectory trajectory = MakeArmTrajectory(model_, Pose::Identity(), limits_, {rest.data(), 1}, rest, 0.0);
  EXPECT_EQ(trajectory.points.back().time_us, 40000);
}

TEST_F(ArmTiming, TimeOfALineIsThatOfItsTrajectory) {
  const std::vector<TrajectoryPoint> points = Make({approach_[0], approach_[1]}).points;
  const auto first = std::find_if(points.begin(), points.end(), [](const TrajectoryPoint& p) { return p.scanning; });
  EXPECT_NEAR(1e-6 * static_cast<double>(first->time_us), CalcJointTime(model_, limits_, approach_[0], approach_[1]),
              0.041);
}

}  // namespace
}  // namespace nbs
