#include "services/sensor/sensor_node.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>

namespace nbs {
namespace {

constexpr size_t kProfile = StreamOf<Profile>();
constexpr size_t kState = StreamOf<RobotState>();

RunConfig MakeConfig() {
  RunConfig config;
  config.cell.profiler.points = 3;
  config.cell.X_FS = MakePose({0.0, 0.1, 0.2}, Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX())));
  return config;
}

RobotState MakeState(int64_t utime_us, int scan, bool end_of_scan = false) {
  RobotState state;
  state.utime_us = utime_us;
  state.scan = scan;
  state.scanning = !end_of_scan;
  state.end_of_scan = end_of_scan;
  state.X_WF.translation().x() = 1e-6 * static_cast<double>(utime_us);
  return state;
}

Profile MakeProfile(int64_t utime_us) { return {utime_us, false, {0.3f, 0.3f, 0.3f}}; }
Profile MakeClosing(int64_t utime_us) { return {utime_us, true, {}}; }

// Feeds the node from two queues until the one it asks for is empty.
class Feeder {
 public:
  std::vector<Stripe> Run(std::deque<Profile> profiles, std::deque<RobotState> states) {
    Outbox out;
    while (true) {
      if (node_.NextInput() == kProfile && !profiles.empty()) {
        node_.Handle(profiles.front(), out);
        profiles.pop_front();
      } else if (node_.NextInput() == kState && !states.empty()) {
        node_.Handle(states.front(), out);
        states.pop_front();
      } else {
        break;
      }
    }
    states_left_ = states.size();
    std::vector<Stripe> stripes;
    for (const Message& message : out) stripes.push_back(std::get<Stripe>(message));
    return stripes;
  }

  int64_t FindComplaint(std::string_view name) const {
    for (const auto& complaint : node_.Complaints()) {
      if (complaint.name == name) return complaint.count;
    }
    ADD_FAILURE() << "no complaint " << name;
    return -1;
  }

  size_t states_left() const { return states_left_; }
  size_t next_input() const { return node_.NextInput(); }

 private:
  SensorNode node_{MakeConfig()};
  size_t states_left_ = 0;
};

TEST(SensorNode, PublishesTheSensorsPoseAtTheStatesTime) {
  Feeder feeder;
  const auto stripes = feeder.Run({MakeProfile(40)}, {MakeState(0, 3), MakeState(40, 3), MakeState(80, 3)});
  ASSERT_EQ(stripes.size(), 1u);
  EXPECT_EQ(stripes[0].utime_us, 40);
  EXPECT_EQ(stripes[0].scan, 3);
  EXPECT_EQ(stripes[0].index, 0);
  EXPECT_FALSE(stripes[0].end_of_scan);
  EXPECT_EQ(stripes[0].X_WS.matrix(), (MakeState(40, 3).X_WF * MakeConfig().cell.X_FS).matrix());
  EXPECT_EQ(stripes[0].ranges_m, MakeProfile(0).ranges_m);
  EXPECT_EQ(feeder.states_left(), 1u);
}

TEST(SensorNode, InterpolatesForAProfileBetweenTwoStates) {
  Feeder feeder;
  const auto stripes = feeder.Run({MakeProfile(10), MakeProfile(30)}, {MakeState(0, 0), MakeState(40, 0)});
  ASSERT_EQ(stripes.size(), 2u);
  EXPECT_TRUE(stripes[0].X_WS.isApprox(MakeState(10, 0).X_WF * MakeConfig().cell.X_FS, 1e-12));
  EXPECT_TRUE(stripes[1].X_WS.isApprox(MakeState(30, 0).X_WF * MakeConfig().cell.X_FS, 1e-12));
}

TEST(SensorNode, ClosesAScanAfterItsLastStateAndNumbersTheNextFromZero) {
  Feeder feeder;
  const auto stripes = feeder.Run(
      {MakeProfile(0), MakeProfile(40), MakeClosing(80), MakeProfile(200), MakeClosing(240)},
      {MakeState(0, 0), MakeState(40, 0), MakeState(80, 0, true), MakeState(200, 1), MakeState(240, 1, true)});
  ASSERT_EQ(stripes.size(), 5u);
  EXPECT_EQ(stripes[2].index, 2);
  EXPECT_TRUE(stripes[2].end_of_scan);
  EXPECT_TRUE(stripes[2].ranges_m.empty());
  EXPECT_EQ(stripes[3].index, 0);
  EXPECT_EQ(stripes[3].scan, 1);
  EXPECT_TRUE(stripes[4].end_of_scan);
  EXPECT_EQ(stripes[4].scan, 1);
}

TEST(SensorNode, ClosesAScanWithoutProfiles) {
  Feeder feeder;
  const auto stripes = feeder.Run({MakeClosing(80)}, {MakeState(80, 5, true)});
  ASSERT_EQ(stripes.size(), 1u);
  EXPECT_TRUE(stripes[0].end_of_scan);
  EXPECT_EQ(stripes[0].scan, 5);
  EXPECT_EQ(feeder.next_input(), kProfile);
}

TEST(SensorNode, ClosesAScanWhoseClosingProfileIsEarlierThanTheLastState) {
  Feeder feeder;
  const auto stripes =
      feeder.Run({MakeProfile(0), MakeClosing(41)}, {MakeState(0, 0), MakeState(40, 0), MakeState(80, 0, true)});
  ASSERT_EQ(stripes.size(), 2u);
  EXPECT_TRUE(stripes[1].end_of_scan);
  EXPECT_EQ(feeder.states_left(), 0u);
}

TEST(SensorNode, RefusesAProfileAfterTheLastStateAndStillClosesTheScan) {
  Feeder feeder;
  const auto stripes =
      feeder.Run({MakeProfile(100), MakeClosing(120)}, {MakeState(0, 0), MakeState(80, 0, true), MakeState(200, 1)});
  ASSERT_EQ(stripes.size(), 1u);
  EXPECT_TRUE(stripes[0].end_of_scan);
  EXPECT_EQ(feeder.FindComplaint("profile_without_pose"), 1);
  EXPECT_EQ(feeder.states_left(), 1u);
}

TEST(SensorNode, RefusesAProfileBeforeTheFirstState) {
  Feeder feeder;
  EXPECT_TRUE(feeder.Run({MakeProfile(10)}, {MakeState(40, 0)}).empty());
  EXPECT_EQ(feeder.FindComplaint("profile_without_pose"), 1);
}

TEST(SensorNode, RefusesAProfileOfAScanThatIsClosed) {
  Feeder feeder;
  const auto stripes = feeder.Run({MakeProfile(0), MakeClosing(30), MakeProfile(60)},
                                  {MakeState(0, 0), MakeState(40, 0), MakeState(80, 0, true)});
  EXPECT_EQ(stripes.size(), 2u);
  EXPECT_EQ(feeder.FindComplaint("profile_without_pose"), 1);
}

TEST(SensorNode, RefusesAProfileBetweenTwoScans) {
  Feeder feeder;
  const auto stripes = feeder.Run({MakeProfile(0), MakeClosing(40), MakeProfile(100)},
                                  {MakeState(0, 0), MakeState(40, 0, true), MakeState(200, 1)});
  EXPECT_EQ(stripes.size(), 2u);
  EXPECT_EQ(feeder.FindComplaint("profile_without_pose"), 1);
}

TEST(SensorNode, RefusesAProfileWithTooFewOrTooManyPoints) {
  Feeder feeder;
  const auto stripes = feeder.Run({{0, false, {0.3f, 0.3f}}, {40, false, {0.3f, 0.3f, 0.3f, 0.3f}}, MakeProfile(80)},
                                  {MakeState(0, 0), MakeState(40, 0), MakeState(80, 0)});
  ASSERT_EQ(stripes.size(), 1u);
  EXPECT_EQ(stripes[0].index, 0);
  EXPECT_EQ(feeder.FindComplaint("profile_points"), 2);
}

TEST(SensorNode, RefusesAProfileThatIsNotLaterThanTheOneBefore) {
  Feeder feeder;
  const auto stripes = feeder.Run({MakeProfile(40), MakeProfile(40), MakeProfile(0), MakeProfile(80)},
                                  {MakeState(0, 0), MakeState(40, 0), MakeState(80, 0)});
  EXPECT_EQ(stripes.size(), 2u);
  EXPECT_EQ(feeder.FindComplaint("profile_time"), 2);
}

TEST(SensorNode, CountsRangesThatItDrops) {
  Feeder feeder;
  const auto stripes = feeder.Run({{40, false, {0.9f, -1.0f, 0.3f}}}, {MakeState(40, 0)});
  ASSERT_EQ(stripes.size(), 1u);
  EXPECT_EQ(stripes[0].ranges_m, (std::vector<float>{0.0f, 0.0f, 0.3f}));
  EXPECT_EQ(feeder.FindComplaint("range_out_of_depth"), 1);
  EXPECT_EQ(feeder.FindComplaint("range_invalid"), 1);
}

}  // namespace
}  // namespace nbs
