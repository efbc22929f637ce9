#include "services/robot/trajectory_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace nbs {
namespace {

constexpr int64_t kPeriod_us = 40'000;

Pose At(double x_m, double turn_rad = 0.0) {
  return MakePose({x_m, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ())));
}

// Approach of 2 periods, scan of 3, retreat of 1.
Trajectory MakeTrajectory() {
  return {0,
          7,
          {{0, At(0), {}, false},
           {2 * kPeriod_us, At(0.2, 0.4), {}, true},
           {5 * kPeriod_us, At(0.5, 0.4), {}, false},
           {6 * kPeriod_us, At(0.6, 0.4), {}, false}}};
}

TEST(TrajectorySampler, IsExactAtEveryPoint) {
  const Trajectory trajectory = MakeTrajectory();
  for (const TrajectoryPoint& point : trajectory.points) {
    EXPECT_EQ(CalcFlangePose(trajectory, point.time_us).matrix(), point.X_WF.matrix());
  }
}

TEST(TrajectorySampler, MovesStraightAndTurnsEvenlyBetweenPoints) {
  EXPECT_TRUE(CalcFlangePose(MakeTrajectory(), kPeriod_us).isApprox(At(0.1, 0.2), 1e-12));
}

TEST(TrajectorySampler, RestsBeforeTheFirstAndAfterTheLastPoint) {
  const Trajectory trajectory = MakeTrajectory();
  EXPECT_EQ(CalcFlangePose(trajectory, -5).matrix(), At(0).matrix());
  EXPECT_EQ(CalcFlangePose(trajectory, 100 * kPeriod_us).matrix(), trajectory.points.back().X_WF.matrix());
}

TEST(TrajectorySampler, ScansFromTheSegmentsStartToItsEnd) {
  const Trajectory trajectory = MakeTrajectory();
  EXPECT_FALSE(IsScanning(trajectory, 2 * kPeriod_us - 1));
  EXPECT_TRUE(IsScanning(trajectory, 2 * kPeriod_us));
  EXPECT_TRUE(IsScanning(trajectory, 5 * kPeriod_us));
  EXPECT_FALSE(IsScanning(trajectory, 5 * kPeriod_us + 1));
}

TEST(TrajectorySampler, DoesNotScanOutsideOfTheTrajectory) {
  const Trajectory trajectory{0, 0, {{10, At(0), {}, true}, {20, At(0), {}, true}}};
  EXPECT_FALSE(IsScanning(trajectory, 9));
  EXPECT_TRUE(IsScanning(trajectory, 10));
  EXPECT_TRUE(IsScanning(trajectory, 20));
  EXPECT_FALSE(IsScanning(trajectory, 21));
}

TEST(TrajectorySampler, GivesOneStateATick) {
  const auto states = SampleStates(MakeTrajectory(), ProfileClock(25.0), 10);
  ASSERT_EQ(states.size(), 7u);
  for (size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(states[i].utime_us, static_cast<int64_t>(10 + i) * kPeriod_us);
    EXPECT_EQ(states[i].scan, 7);
    EXPECT_EQ(states[i].scanning, i >= 2 && i <= 5);
    EXPECT_FALSE(states[i].end_of_scan);
  }
}

TEST(TrajectorySampler, GivesOneStateWhereTwoScanningSegmentsMeet) {
  Trajectory trajectory = MakeTrajectory();
  trajectory.points[2].scanning = true;
  const auto states = SampleStates(trajectory, ProfileClock(25.0), 0);
  EXPECT_EQ(std::count_if(states.begin(), states.end(), [](const RobotState& s) { return s.scanning; }), 5);
  EXPECT_EQ(states.size(), 7u);
}

TEST(TrajectorySampler, AMotionlessTrajectoryGivesOneState) {
  EXPECT_EQ(SampleStates({0, 0, {{0, At(0), {}, false}}}, ProfileClock(25.0), 0).size(), 1u);
}

}  // namespace
}  // namespace nbs
