#include "services/robot/trajectory_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nbs {
namespace {

using testing::HasSubstr;

Pose At(double x_m, double turn_rad = 0.0) {
  return MakePose({x_m, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ())));
}

// 1 s of moving at 0.25 m/s and turning at 0.8 rad/s, then 2 s of scanning at 0.05 m/s.
Trajectory MakeFastest() {
  return {0, 0, {{0, At(0), {}, false}, {1'000'000, At(0.25, 0.8), {}, true}, {3'000'000, At(0.35, 0.8), {}, false}}};
}

std::string Check(const Trajectory& trajectory, const Pose& X_WF = At(0)) { return FindRefusal(trajectory, X_WF, {}); }

TEST(TrajectoryCheck, AMotionAtTheLimitsPasses) { EXPECT_EQ(Check(MakeFastest()), ""); }

TEST(TrajectoryCheck, AMotionLessThanOnePercentTooFastPasses) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[1].time_us = 992'000;
  trajectory.points[2].time_us = 992'000 + 1'985'000;
  EXPECT_EQ(Check(trajectory), "");
}

TEST(TrajectoryCheck, MovingTooFastIsRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[0].X_WF = At(-0.01, 0.1);
  EXPECT_THAT(Check(trajectory, At(-0.01, 0.1)), HasSubstr("Between points 0 and 1 it moves at 0.2600 m/s"));
}

TEST(TrajectoryCheck, ScanningFasterThanTheScanSpeedIsRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[2].X_WF = At(0.36, 0.8);
  EXPECT_THAT(Check(trajectory), HasSubstr("Between points 1 and 2 it scans at 0.0550 m/s"));
}

TEST(TrajectoryCheck, TheScanSpeedIsThatOfTheSensorAndNotOfTheFlange) {
  // The sensor's origin rests 0.1 m ahead of the flange, which turns around it at 0.5 rad/s and so moves at 0.05 m/s.
  RobotLimits limits;
  limits.X_FS = MakePose({0.1, 0, 0}, Eigen::Quaterniond::Identity());
  limits.scan_speed_m_per_s = 0.001;
  const Pose X_FS_inverse = limits.X_FS.inverse();
  const Trajectory around{
      0, 0, {{0, At(0) * X_FS_inverse, {}, true}, {1'000'000, At(0, 0.5) * X_FS_inverse, {}, false}}};
  EXPECT_EQ(FindRefusal(around, around.points[0].X_WF, limits), "");
  limits.X_FS = Pose::Identity();
  EXPECT_THAT(FindRefusal(around, around.points[0].X_WF, limits), HasSubstr("it scans at 0.04"));
}

TEST(TrajectoryCheck, TurningTooFastIsRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[1].X_WF = At(0.25, 0.9);
  EXPECT_THAT(Check(trajectory), HasSubstr("Between points 0 and 1 it turns at 0.9"));
}

TEST(TrajectoryCheck, AStartAwayFromTheRobotIsRefused) {
  EXPECT_EQ(Check(MakeFastest(), At(0.0009)), "");
  EXPECT_THAT(Check(MakeFastest(), At(0.0011)), HasSubstr("away from where the robot is"));
  EXPECT_EQ(Check(MakeFastest(), At(0, 0.0087)), "");
  EXPECT_THAT(Check(MakeFastest(), At(0, 0.0088)), HasSubstr("away from where the robot is"));
}

TEST(TrajectoryCheck, TimesThatDoNotRiseAreRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[2].time_us = 1'000'000;
  EXPECT_THAT(Check(trajectory), HasSubstr("point 2, 1000000 us, is not later"));
}

TEST(TrajectoryCheck, APoseThatIsNotRigidIsRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[1].X_WF.linear() *= 1.01;
  EXPECT_EQ(Check(trajectory), "The pose of point 1 is no rigid transform.");
}

TEST(TrajectoryCheck, ATrajectoryWithoutPointsIsRefused) { EXPECT_EQ(Check({}), "The trajectory has no points."); }

TEST(TrajectoryCheck, JointsAreRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[0].joints_rad = {0.1};
  EXPECT_THAT(Check(trajectory), HasSubstr("has joints"));
}

TEST(TrajectoryCheck, AMotionOfMoreThanADayIsRefused) {
  Trajectory trajectory = MakeFastest();
  trajectory.points[2].time_us = 24ll * 3600 * 1'000'000 + 1;
  EXPECT_THAT(Check(trajectory), HasSubstr("more than a day"));
}

TEST(TrajectoryCheck, LimitsComeFromTheCell) {
  CellConfig cell;
  cell.move_speed_m_per_s = 1.0;
  cell.turn_speed_rad_per_s = 2.0;
  cell.profiler.scan_speed_m_per_s = 3.0;
  cell.X_FS = At(0.7);
  const RobotLimits limits = MakeRobotLimits(cell);
  EXPECT_EQ(limits.move_speed_m_per_s, 1.0);
  EXPECT_EQ(limits.turn_speed_rad_per_s, 2.0);
  EXPECT_EQ(limits.scan_speed_m_per_s, 3.0);
  EXPECT_EQ(limits.X_FS.matrix(), cell.X_FS.matrix());
}

}  // namespace
}  // namespace nbs
