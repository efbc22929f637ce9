#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "common/bus/lcm_transport.h"
#include "common/bus/offline.h"
#include "common/config/run_config.h"
#include "tests/common/bus/child.h"
#include "tests/common/bus/test_service.h"

namespace nbs {
namespace {

constexpr int kStates = 3000;

std::string ReadAll(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// A run folder and the services that run for it, each a process.
class Services : public testing::Test {
 protected:
  void SetUp() override { WriteConfig(false); }
  void WriteConfig(bool realtime) {
    RunConfig config;
    config.folder = folder_.path();
    config.name = "test";
    config.run_id = 7;
    config.version = std::string("0");
    config.realtime = realtime;
    config.grid.size = {10, 10, 10};
    config.first_path.X_WS_end.translation().z() = 0.1;
    WriteRunConfig(config);
  }
  std::unique_ptr<Child> Start(const std::string& service, const std::string& kind, int count, int size,
                               std::vector<std::string> options = {}) {
    std::vector<std::string> command = {
        ProbeService(),          service,     kind, std::to_string(count), std::to_string(size), "--run",
        folder_.path().string(), "--lcm-url", url_};
    command.insert(command.end(), options.begin(), options.end());
    return std::make_unique<Child>(command, log(service));
  }
  std::unique_ptr<Child> StartRobot() { return Start("robot", "robot", kStates, 0); }
  std::unique_ptr<Child> StartSimulator() { return Start("simulator", "simulator", kStates, 224); }
  std::unique_ptr<Child> StartSensor(std::vector<std::string> options = {"--exit-when-finished"}) {
    return Start("sensor", "sensor", 0, 0, std::move(options));
  }
  std::string log(const std::string& service) const { return folder_.path() / (service + ".log"); }
  std::string streams(const std::string& channel) const { return ReadAll(HistoryPath(folder_.path(), channel)); }

  TemporaryFolder folder_;
  std::string url_ = MakeTestUrl();
};

TEST_F(Services, RunAsProcesses) {
  const auto robot = StartRobot();
  const auto simulator = StartSimulator();
  EXPECT_EQ(StartSensor()->Wait(20), 0) << ReadAll(log("sensor"));
  EXPECT_EQ(StreamReader(folder_.path(), StreamOf<Profile>()).size(), kStates);
  EXPECT_NE(ReadAll(log("sensor")).find("nbs-sensor: ready\n"), std::string::npos);
}

TEST_F(Services, EndCleanlyOnSigtermAndSigint) {
  const auto robot = StartRobot();
  const auto simulator = StartSimulator();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  robot->Signal(SIGTERM);
  simulator->Signal(SIGINT);
  EXPECT_EQ(robot->Wait(5), 128 + SIGTERM);
  EXPECT_EQ(simulator->Wait(5), 128 + SIGINT);
  EXPECT_FALSE(robot->was_killed());
  EXPECT_FALSE(simulator->was_killed());
}

TEST_F(Services, EndOnSigtermInTheMiddleOfALongComputation) {
  const auto busy = Start("mesher", "busy", 0, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  busy->Signal(SIGTERM);
  EXPECT_EQ(busy->Wait(5), 128 + SIGTERM);
}

TEST_F(Services, KilledInMidStreamMakeTheSameHistory) {
  std::string undisturbed;
  {
    const auto robot = StartRobot();
    const auto simulator = StartSimulator();
    ASSERT_EQ(StartSensor()->Wait(20), 0);
    undisturbed = streams("PROFILE");
  }
  std::filesystem::remove_all(folder_.path() / "streams");
  const auto robot = StartRobot();
  const auto sensor = StartSensor();
  int killed_early = 0;
  for (int i = 0; i < 4; ++i) {
    const auto simulator = StartSimulator();
    std::this_thread::sleep_for(std::chrono::milliseconds(60 + 20 * i));
    simulator->Signal(SIGKILL);
    if (streams("PROFILE").size() < undisturbed.size()) ++killed_early;
  }
  const auto simulator = StartSimulator();
  EXPECT_EQ(sensor->Wait(20), 0) << ReadAll(log("sensor"));
  EXPECT_GT(killed_early, 0);
  EXPECT_TRUE(streams("PROFILE") == undisturbed);
}

TEST_F(Services, ThatMakeAnotherOutputAgainFailWithChannelAndNumber) {
  {
    const auto first = Start("sensor", "fickle", 0, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  EXPECT_EQ(Start("sensor", "fickle", 0, 0)->Wait(5), 2);
  EXPECT_NE(ReadAll(log("sensor"))
                .find("message 0 on STRIPE, made again from the same inputs, differs from the recorded one at byte"),
            std::string::npos)
      << ReadAll(log("sensor"));
}

TEST_F(Services, RefuseASecondProcessForTheSameRun) {
  const auto first = StartRobot();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(StartRobot()->Wait(5), 1);
}

TEST_F(Services, NameAMissingRunFolder) {
  Child child({ProbeService(), "robot", "robot", "1", "1", "--run", "/nowhere"}, log("robot"));
  EXPECT_EQ(child.Wait(5), 1);
  EXPECT_NE(ReadAll(log("robot")).find("/nowhere"), std::string::npos);
}

TEST_F(Services, RefuseAnUnknownOption) { EXPECT_EQ(Start("robot", "robot", 1, 1, {"--fast"})->Wait(5), 1); }

TEST_F(Services, SayHowToOpenABusWithoutARoute) {
  const std::vector<std::string> in_empty_network = {"unshare", "-Urn", "true"};
  if (Child(in_empty_network).Wait(5) != 0) GTEST_SKIP() << "user namespaces are not allowed here";
  Child child({"unshare", "-Urn", ProbeService(), "robot", "robot", "1", "1", "--run", folder_.path().string(),
               "--lcm-url", url_},
              log("robot"));
  EXPECT_EQ(child.Wait(5), 1);
  EXPECT_NE(ReadAll(log("robot")).find("no multicast route, run `ip route add 239.255.76.67/32 dev lo`"),
            std::string::npos)
      << ReadAll(log("robot"));
}

TEST_F(Services, SurviveMalformedDatagrams) {
  const auto robot = StartRobot();
  const auto sensor = StartSensor({"--exit-when-finished"});
  LcmTransport attacker(url_);
  const auto flood = [&](uint64_t round) {
    for (uint64_t i = 0; i < 50; ++i) {
      std::vector<uint8_t> noise((round * 37 + i * 13) % 300, static_cast<uint8_t>(i));
      for (const char* channel :
           {"PROFILE", "ROBOT_STATE", "REPAIR", "STATUS_simulator", "STATUS_sensor", "STATUS_robot"}) {
        attacker.Publish(channel, noise);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  for (uint64_t round = 0; round < 30; ++round) flood(round);
  const auto simulator = StartSimulator();
  for (uint64_t round = 0; round < 30; ++round) flood(round);
  EXPECT_EQ(sensor->Wait(20), 0) << ReadAll(log("sensor"));
}

TEST_F(Services, PaceTheRobotInRealTime) {
  WriteConfig(true);
  const auto robot = Start("robot", "robot", 26, 0);
  const auto simulator = StartSimulator();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(StartSensor()->Wait(20), 0);
  EXPECT_GT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(950));
}

TEST_F(Services, CarryLargeMessagesWithDefaultBuffers) {
  constexpr int kMessages = 700;  // 40 MB
  const auto mesher = Start("mesher", "mesher", kMessages, 57000, {"--without", "planner"});
  const auto reporter = Start("reporter", "reporter", 0, 0);
  EXPECT_EQ(reporter->Wait(30), 0) << ReadAll(log("reporter"));
  StreamReader reader(folder_.path(), StreamOf<MeshDelta>());
  EXPECT_EQ(reader.size(), kMessages);
}

}  // namespace
}  // namespace nbs
