#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "common/bus/compare.h"
#include "common/bus/lcm_log.h"
#include "common/bus/lcm_transport.h"
#include "common/bus/log_store.h"
#include "common/bus/lossy_transport.h"
#include "common/bus/merge.h"
#include "common/bus/offline.h"
#include "common/bus/repair_server.h"
#include "common/messages/translate.h"
#include "common/runtime/error.h"
#include "tests/common/bus/child.h"
#include "tests/common/bus/fake_nodes.h"
#include "tests/common/bus/test_service.h"

namespace nbs {
namespace {

constexpr int kStates = 300;

// What the services of a run leave in its folder, made without a bus.
void MakeRun(const std::filesystem::path& folder) {
  FakeRobot robot(kStates);
  Outbox out;
  robot.Start(out);
  Recorder("robot", 7, folder).Record(out);
  FakeSimulator simulator(224);
  Recorder recorder("simulator", 7, folder);
  for (const Message& state : out) {
    Outbox profiles;
    simulator.Handle(state, profiles);
    recorder.Record(profiles);
  }
}

class RecordedRun : public testing::Test {
 protected:
  void SetUp() override {
    MakeRun(folder_.path());
    MergeHistories(folder_.path() / "streams", log_);
  }
  std::vector<LogEvent> ReadLog() const {
    std::vector<LogEvent> events;
    LcmLogReader reader(log_);
    for (LogEvent event; reader.Next(event);) events.push_back(event);
    return events;
  }
  // Appends a state of the coordinator to the log.
  void AddRunState(RunPhase phase, int64_t seq) const {
    RunState state;
    state.phase = phase;
    const MessageHeader header{7, seq, 0, "coordinator"};
    const std::vector<uint8_t> bytes = EncodeLogEvent(2 * kStates + seq, 0, "RUN_STATE", Encode(header, state));
    std::ofstream log(log_, std::ios::binary | std::ios::app);
    log.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  // Changes one byte of a file.
  static void Damage(const std::filesystem::path& file, int64_t offset) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(offset);
    const int byte = stream.get();
    stream.seekp(offset);
    stream.put(static_cast<char>(byte ^ 1));
  }

  TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "bus.lcm";
  std::filesystem::path streams_ = folder_.path() / "streams";
};

TEST_F(RecordedRun, IsMergedInTheOrderOfTimeSourceAndNumber) {
  const std::vector<LogEvent> events = ReadLog();
  ASSERT_EQ(events.size(), 2u * kStates);
  for (size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].number, static_cast<int64_t>(i));
    EXPECT_EQ(events[i].timestamp_us, static_cast<int64_t>(i / 2) * 40000);
    EXPECT_EQ(events[i].channel, i % 2 == 0 ? "ROBOT_STATE" : "PROFILE");
    EXPECT_EQ(DecodeHeader(events[i].data)->seq, static_cast<int64_t>(i / 2));
  }
}

TEST_F(RecordedRun, IsMergedWithoutTheTornTailOfAHistory) {
  const std::filesystem::path profiles = streams_ / "PROFILE.lcm";
  std::filesystem::resize_file(profiles, std::filesystem::file_size(profiles) - 5);
  EXPECT_EQ(MergeHistories(streams_, log_), 2 * kStates - 1);
}

TEST_F(RecordedRun, IsPlayedByLcmLogplayer) {
  const std::string url = MakeTestUrl();
  LcmTransport bus(url);
  bus.Subscribe("ROBOT_STATE");
  int64_t played = 0;
  int64_t next = 0;
  Child player({"lcm-logplayer", "--speed=10", "--lcm-url=" + url, log_.string()}, folder_.path() / "player.log");
  const auto until = Clock::now() + std::chrono::seconds(10);
  while (Clock::now() < until && next < kStates) {
    bus.Poll(std::chrono::milliseconds(50), [&](std::string_view, std::span<const uint8_t> data) {
      next = DecodeHeader(data)->seq + 1;
      ++played;
    });
  }
  EXPECT_EQ(next, kStates);
  EXPECT_GT(played, kStates / 2);
  EXPECT_EQ(player.Wait(5), 0);
}

TEST_F(RecordedRun, IsFoldedOfflineUntilTheNodeHasFinished) {
  FakeSensor sensor;
  EXPECT_EQ(RunOffline(sensor, folder_.path()), 2 * kStates);
  EXPECT_EQ(sensor.states().back().utime_us, 40000 * (kStates - 1));
}

TEST_F(RecordedRun, IsFoldedOfflineAsFarAsItGoes) {
  std::filesystem::remove(streams_ / "ROBOT_STATE.lcm");
  FakeSensor sensor;
  EXPECT_EQ(RunOffline(sensor, folder_.path()), 1);
}

TEST_F(RecordedRun, EqualsItsOwnLog) {
  const ChannelComparison result = CompareChannel(log_, streams_, "PROFILE");
  EXPECT_EQ(result.difference, "");
  EXPECT_EQ(result.identical, kStates);
}

TEST_F(RecordedRun, DiffersFromAChangedOneAtANamedByte) {
  LogEvent event;
  LcmLogReader reader(streams_ / "PROFILE.lcm");
  for (int i = 0; i < 4; ++i) reader.Next(event);
  Damage(streams_ / "PROFILE.lcm", event.data_offset + 100);
  const ChannelComparison result = CompareChannel(log_, streams_, "PROFILE");
  EXPECT_EQ(result.identical, 3);
  const std::string size = std::to_string(event.data.size());
  EXPECT_EQ(result.difference,
            "PROFILE message 3 differs at byte 100 (" + size + " bytes recorded, " + size + " made)");
}

TEST_F(RecordedRun, ThatWasCutShortHasNoDifferenceInWhatWasMadeBeyondIt) {
  const std::string program = std::string(NBS_BINARY_DIR) + "/bin/nbs-compare";
  const auto compare = [&] {
    return Child({program, "--log", log_, "--streams", streams_, "--channels", "PROFILE"}).Wait(10);
  };
  // The last profile comes last of all.
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) - 28 - 7 - ReadLog().back().data.size());
  EXPECT_TRUE(CameToItsEnd(log_));
  EXPECT_EQ(CompareChannel(log_, streams_, "PROFILE").difference, "PROFILE message 299 was made but not recorded");
  EXPECT_EQ(compare(), 2);
  AddRunState(RunPhase::kScanning, 0);
  EXPECT_FALSE(CameToItsEnd(log_));
  const ChannelComparison result = CompareChannel(log_, streams_, "PROFILE", false);
  EXPECT_EQ(result.difference, "");
  EXPECT_EQ(result.identical, kStates - 1);
  EXPECT_EQ(compare(), 0);
  AddRunState(RunPhase::kFinished, 1);
  EXPECT_TRUE(CameToItsEnd(log_));
  EXPECT_EQ(compare(), 2);
}

TEST_F(RecordedRun, ThatWasCutShortStillDiffersInWhatItHas) {
  std::filesystem::resize_file(streams_ / "PROFILE.lcm", std::filesystem::file_size(streams_ / "PROFILE.lcm") - 1);
  EXPECT_EQ(CompareChannel(log_, streams_, "PROFILE", false).difference,
            "PROFILE message 299 was recorded but not made");
}

TEST_F(RecordedRun, DiffersFromAShorterOne) {
  std::filesystem::resize_file(streams_ / "PROFILE.lcm", std::filesystem::file_size(streams_ / "PROFILE.lcm") - 1);
  EXPECT_EQ(CompareChannel(log_, streams_, "PROFILE").difference, "PROFILE message 299 was recorded but not made");
  std::filesystem::remove(streams_ / "PROFILE.lcm");
  EXPECT_EQ(CompareChannel(log_, streams_, "PROFILE").difference, "PROFILE message 0 was recorded but not made");
}

TEST_F(RecordedRun, ThatLacksAMessageInItsLogIsNamed) {
  const std::vector<LogEvent> events = ReadLog();
  std::ofstream log(log_, std::ios::binary);
  for (const LogEvent& event : events) {
    if (event.channel == "PROFILE" && DecodeHeader(event.data)->seq == 5) continue;
    const std::vector<uint8_t> bytes = EncodeLogEvent(event.number, event.timestamp_us, event.channel, event.data);
    log.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  log.close();
  EXPECT_THROW(CompareChannel(log_, streams_, "PROFILE"), RunFailure);
}

TEST_F(RecordedRun, IsComparedByTheProgramWithItsExitCodes) {
  const std::string program = std::string(NBS_BINARY_DIR) + "/bin/nbs-compare";
  const auto compare = [&](const std::string& log, const std::string& channels) {
    return Child({program, "--log", log, "--streams", streams_.string(), "--channels", channels}).Wait(10);
  };
  EXPECT_EQ(compare(log_, "PROFILE,ROBOT_STATE,MESH"), 0);
  EXPECT_EQ(compare("/nowhere/bus.lcm", "PROFILE"), 2);
  EXPECT_EQ(Child({program, "--log", log_.string()}).Wait(10), 1);
  Damage(log_, 28 + 11);
  EXPECT_EQ(compare(log_, "ROBOT_STATE"), 2);
}

// The sensor of a replay: it reads what lcm-logplayer plays, loses a part of it, and has it repaired.
class Replay : public RecordedRun {
 protected:
  void Play(double drop, bool with_player) {
    const std::string url = MakeTestUrl();
    LcmTransport server_bus(url);
    RepairServer server(log_, {"PROFILE", "ROBOT_STATE"}, server_bus);
    std::thread serving([&] { server.Run(); });
    TemporaryFolder new_run;
    TestService sensor({"sensor", 7, new_run.path(), false, {"mesher", "voxelmap"}, true},
                       std::make_unique<FakeSensor>(),
                       std::make_unique<LossyTransport>(std::make_unique<LcmTransport>(url), drop, 1));
    std::unique_ptr<Child> player;
    if (with_player) {
      player =
          std::make_unique<Child>(std::vector<std::string>{"lcm-logplayer", "--speed=0", "-e", "(PROFILE|ROBOT_STATE)",
                                                           "--lcm-url=" + url, log_.string()},
                                  folder_.path() / "player.log");
    }
    EXPECT_TRUE(sensor.WaitForEnd(std::chrono::seconds(20)));
    sensor.Stop();
    EXPECT_EQ(sensor.node<FakeSensor>().profiles().size(), static_cast<size_t>(kStates));
    server.Stop();
    serving.join();
  }
};

TEST_F(Replay, IsCompleteThoughTheLogplayerWaitsForNobody) { Play(0.0, true); }
TEST_F(Replay, IsCompleteWithATenthLost) { Play(0.1, true); }
TEST_F(Replay, IsCompleteWhenTheLogplayerNeverCame) { Play(0.0, false); }

TEST_F(RecordedRun, HasNoRepairForAChannelThatIsNoStream) {
  LcmTransport bus(MakeTestUrl());
  EXPECT_THROW(RepairServer(log_, {"NOISE"}, bus), ConfigError);
  EXPECT_THROW(RepairServer(log_, {"MESH"}, bus), ConfigError);
}

}  // namespace
}  // namespace nbs
