#include "services/planner/motion_planning/timing.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

Pose MakeTurn(const Eigen::Vector3d& p_W, double angle_rad) {
  return MakePose(p_W, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ())));
}

const TimingLimits kLimits;  // 0.25 m/s, 0.8 rad/s, 0.05 m/s, 40 ms

std::vector<Pose> MakeScan(const Pose& X_WF) {
  return {X_WF, MakeTurn(X_WF.translation() + Eigen::Vector3d(0.1, 0, 0), 0.0)};
}

TEST(Timing, SlowerOfMoveAndTurnCounts) {
  EXPECT_NEAR(CalcMotionTime(kLimits, Pose::Identity(), MakeTurn({0.5, 0, 0}, 0.4)), 2.0, 1e-12);
  EXPECT_NEAR(CalcMotionTime(kLimits, Pose::Identity(), MakeTurn({0.05, 0, 0}, 0.4)), 0.5, 1e-12);
}

TEST(Timing, ScanBeginsOnAMultipleOfTheProfilePeriod) {
  const Pose X_start = MakeTurn({0.123, 0, 0}, 0.0);
  const Trajectory trajectory =
      MakeTrajectory(kLimits, std::vector<Pose>{Pose::Identity(), X_start}, MakeScan(X_start), 0.1);
  ASSERT_EQ(trajectory.points.size(), 3u);
  EXPECT_EQ(trajectory.points[1].time_us, 520000);  // 0.492 s at the limit
  EXPECT_TRUE(trajectory.points[1].scanning);
}

TEST(Timing, ScanKeepsTheScanSpeed) {
  const Trajectory trajectory =
      MakeTrajectory(kLimits, std::vector<Pose>{Pose::Identity()}, MakeScan(Pose::Identity()), 0.1);
  ASSERT_EQ(trajectory.points.size(), 2u);
  EXPECT_TRUE(trajectory.points[0].scanning);
  EXPECT_FALSE(trajectory.points[1].scanning);
  EXPECT_NEAR(static_cast<double>(trajectory.points[1].time_us), 2e6, 1.0);
}

TEST(Timing, TurningScanKeepsTheTurnSpeed) {
  const std::vector<Pose> scan_WF = {Pose::Identity(), MakeTurn({0.01, 0, 0}, 1.2)};
  const Trajectory trajectory = MakeTrajectory(kLimits, std::vector<Pose>{Pose::Identity()}, scan_WF, 0.01);
  EXPECT_NEAR(static_cast<double>(trajectory.points.back().time_us), 1.5e6, 1.0);
}

TEST(Timing, FlangeNoFasterThanTheScanWhereTheSensorStandsOff) {
  const std::vector<Pose> scan_WF = {Pose::Identity(), MakeTurn({0.2, 0, 0}, 0.0)};
  const Trajectory trajectory = MakeTrajectory(kLimits, std::vector<Pose>{Pose::Identity()}, scan_WF, 0.1);
  EXPECT_NEAR(static_cast<double>(trajectory.points.back().time_us), 4e6, 1.0);
}

TEST(Timing, ScanWithoutLengthLastsOneProfile) {
  const std::vector<Pose> scan_WF = {Pose::Identity(), Pose::Identity()};
  const Trajectory trajectory = MakeTrajectory(kLimits, std::vector<Pose>{Pose::Identity()}, scan_WF, 0.0);
  EXPECT_EQ(trajectory.points.back().time_us, kLimits.profile_period_us);
}

TEST(Timing, HalfATurnIsGivenPointsOnItsWay) {
  const Pose X_start = MakeTurn({0, 0, 0}, 3.14159);
  std::vector<Pose> scan_WF = {X_start, X_start};
  scan_WF[1].translation().z() = 0.1;
  const Trajectory trajectory = MakeTrajectory(kLimits, std::vector<Pose>{Pose::Identity(), X_start}, scan_WF, 0.1);
  ASSERT_EQ(trajectory.points.size(), 5u);
  for (size_t k = 0; k + 1 < trajectory.points.size(); ++k) {
    EXPECT_LE(CalcAngleBetween(trajectory.points[k].X_WF, trajectory.points[k + 1].X_WF), 1.5);
    EXPECT_EQ(trajectory.points[k].scanning, k == 3);
  }
}

TEST(Timing, StandingStillInTheApproachTakesNoPoints) {
  const Pose X = MakeTurn({0.1, 0.2, 0.3}, 0.5);
  EXPECT_EQ(MakeTrajectory(kLimits, std::vector<Pose>{X, X, X}, MakeScan(X), 0.1).points.size(), 2u);
}

TEST(Timing, LimitsAreThoseOfTheCell) {
  CellConfig cell;
  cell.move_speed_m_per_s = 0.1;
  cell.profiler.rate_hz = 200.0;
  EXPECT_EQ(MakeLimits(cell).move_m_per_s, 0.1);
  EXPECT_EQ(MakeLimits(cell).profile_period_us, 5000);
  cell.turn_speed_rad_per_s = 0.0;
  EXPECT_THROW(MakeLimits(cell), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
