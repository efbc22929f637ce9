#include "services/sensor/pose_track.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

RobotState MakeState(int64_t utime_us, int scan, double x_m, double turn_rad = 0.0) {
  RobotState state;
  state.utime_us = utime_us;
  state.scan = scan;
  state.X_WF = MakePose({x_m, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ())));
  return state;
}

TEST(PoseTrack, KnowsNoPoseBeforeTheFirstState) { EXPECT_FALSE(PoseTrack().FindPose(0).has_value()); }

TEST(PoseTrack, GivesTheStatesPoseExactlyAtItsTime) {
  PoseTrack track;
  const RobotState first = MakeState(100, 0, 0.1, 0.3);
  const RobotState second = MakeState(200, 0, 0.7, 1.1);
  track.Add(first);
  track.Add(second);
  EXPECT_EQ(track.FindPose(100)->matrix(), first.X_WF.matrix());
  EXPECT_EQ(track.FindPose(200)->matrix(), second.X_WF.matrix());
}

TEST(PoseTrack, InterpolatesPositionAndRotationBetweenStates) {
  PoseTrack track;
  track.Add(MakeState(100, 0, 0.0, 0.0));
  track.Add(MakeState(200, 0, 1.0, 0.8));
  EXPECT_TRUE(track.FindPose(125)->isApprox(MakeState(0, 0, 0.25, 0.2).X_WF, 1e-12));
}

TEST(PoseTrack, KnowsNoPoseOutsideOfItsStates) {
  PoseTrack track;
  track.Add(MakeState(100, 0, 0.0));
  track.Add(MakeState(200, 0, 1.0));
  EXPECT_FALSE(track.FindPose(99).has_value());
  EXPECT_FALSE(track.FindPose(201).has_value());
}

TEST(PoseTrack, DoesNotInterpolateBetweenTwoScans) {
  PoseTrack track;
  track.Add(MakeState(100, 0, 0.0));
  track.Add(MakeState(200, 1, 1.0));
  EXPECT_FALSE(track.FindPose(150).has_value());
  EXPECT_TRUE(track.FindPose(200).has_value());
}

}  // namespace
}  // namespace nbs
