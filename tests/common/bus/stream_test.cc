#include <gtest/gtest.h>

#include "common/bus/lcm_transport.h"
#include "common/bus/lossy_transport.h"
#include "common/bus/window.h"
#include "tests/common/bus/fake_nodes.h"
#include "tests/common/bus/memory_bus.h"
#include "tests/common/bus/test_service.h"

namespace nbs {
namespace {

using std::chrono::seconds;

// A chain of three services: the robot's states go to simulator and sensor, the simulator's profiles to the sensor.
class Chain {
 public:
  using MakeTransport = std::function<std::unique_ptr<Transport>(int member)>;

  explicit Chain(MakeTransport make_transport, int states = 400)
      : make_transport_(std::move(make_transport)), states_(states) {}

  void StartRobot() { robot_ = Make("robot", std::make_unique<FakeRobot>(states_), 0, {}); }
  void StartSimulator() { simulator_ = Make("simulator", std::make_unique<FakeSimulator>(224), 1, {}); }
  void StartSensor() { sensor_ = Make("sensor", std::make_unique<FakeSensor>(), 2, {"mesher", "voxelmap"}); }
  void StartAll() {
    StartRobot();
    StartSimulator();
    StartSensor();
  }

  bool WaitForEnd(seconds limit = seconds(20)) const { return sensor_->WaitForEnd(limit); }
  void KillSimulator() { simulator_.reset(); }
  void KillSensor() { sensor_.reset(); }
  TestService& robot() { return *robot_; }
  TestService& simulator() { return *simulator_; }
  TestService& sensor() { return *sensor_; }
  const FakeSensor& read() const { return sensor_->node<FakeSensor>(); }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  std::unique_ptr<TestService> Make(const std::string& service, std::unique_ptr<Node> node, int member,
                                    std::vector<std::string> without) {
    const ServiceSetup setup{service, 7, folder_.path(), false, std::move(without), service == "sensor"};
    return std::make_unique<TestService>(setup, std::move(node), make_transport_(member));
  }

  TemporaryFolder folder_;
  MakeTransport make_transport_;
  int states_;
  std::unique_ptr<TestService> robot_;
  std::unique_ptr<TestService> simulator_;
  std::unique_ptr<TestService> sensor_;
};

Chain::MakeTransport OnMemory(MemoryBus& bus) {
  return [&bus](int) { return bus.Join(); };
}

Chain::MakeTransport OnUdp(const std::string& url) {
  return [url](int) { return std::make_unique<LcmTransport>(url); };
}

Chain::MakeTransport Lossy(Chain::MakeTransport inner, double drop) {
  return [inner = std::move(inner), drop](int member) {
    return std::make_unique<LossyTransport>(inner(member), drop, static_cast<uint64_t>(member));
  };
}

void ExpectComplete(const FakeSensor& read, int states) {
  ASSERT_EQ(read.states().size(), static_cast<size_t>(states));
  ASSERT_EQ(read.profiles().size(), static_cast<size_t>(states));
  for (int i = 0; i < states; ++i) {
    EXPECT_EQ(read.states()[static_cast<size_t>(i)].utime_us, 40000 * i);
    EXPECT_EQ(read.profiles()[static_cast<size_t>(i)].utime_us, 40000 * i);
  }
}

TEST(Stream, ArrivesCompleteAndInOrder) {
  MemoryBus bus(kStockReceiveBuffer);
  Chain chain(OnMemory(bus));
  chain.StartAll();
  ASSERT_TRUE(chain.WaitForEnd());
  ExpectComplete(chain.read(), 400);
}

ServiceSetup MakeSetup(const std::string& service, const TemporaryFolder& folder,
                       std::vector<std::string> without = {}) {
  return {service, 7, folder.path(), false, std::move(without), false};
}

TEST(Stream, NeverOverflowsTheStockBufferOfItsReceiver) {
  MemoryBus bus(kStockReceiveBuffer);
  TemporaryFolder folder;
  TestService mesher(MakeSetup("mesher", folder, {"planner"}), std::make_unique<FakeMesher>(300, 55000), bus.Join());
  TestService reporter(MakeSetup("reporter", folder), std::make_unique<FakeReader<MeshDelta>>(), bus.Join());
  ASSERT_TRUE(reporter.WaitForEnd(seconds(20)));
  EXPECT_EQ(bus.lost(), 0);
  mesher.Stop();
  EXPECT_LE(mesher.runner().publisher().ledger().peak_bytes(), static_cast<int64_t>(CalcWindowBytes("mesher")));
}

// Small messages along the chain and large ones from mesher and voxelmap to planner and reporter, through everybody's
// buffers at once.
TEST(Stream, ArrivesCompleteWhenAllServicesTalkTogether) {
  MemoryBus bus(kStockReceiveBuffer);
  Chain chain(OnMemory(bus), 2000);
  TemporaryFolder folder;
  TestService mesher(MakeSetup("mesher", folder), std::make_unique<FakeMesher>(100, 55000), bus.Join());
  TestService voxelmap(MakeSetup("voxelmap", folder), std::make_unique<FakeVoxelmap>(100, 55000), bus.Join());
  TestService planner(MakeSetup("planner", folder), std::make_unique<FakeReader<MeshDelta>>(), bus.Join());
  TestService reporter(MakeSetup("reporter", folder), std::make_unique<FakeReader<VoxelDelta>>(), bus.Join());
  chain.StartAll();
  ASSERT_TRUE(chain.WaitForEnd());
  ASSERT_TRUE(reporter.WaitForEnd(seconds(20)));
  ExpectComplete(chain.read(), 2000);
  EXPECT_EQ(reporter.node<FakeReader<VoxelDelta>>().utimes().size(), 100u);
}

TEST(Stream, ArrivesCompleteThroughABufferThatIsMuchTooSmall) {
  MemoryBus bus(12000);
  Chain chain(OnMemory(bus));
  chain.StartAll();
  ASSERT_TRUE(chain.WaitForEnd());
  EXPECT_GT(bus.lost(), 0);
  ExpectComplete(chain.read(), 400);
}

TEST(Stream, ArrivesCompleteOverUdp) {
  Chain chain(OnUdp(MakeTestUrl()), 2000);
  chain.StartAll();
  ASSERT_TRUE(chain.WaitForEnd());
  ExpectComplete(chain.read(), 2000);
}

class LossyStream : public testing::TestWithParam<double> {};

TEST_P(LossyStream, IsRepaired) {
  Chain chain(Lossy(OnUdp(MakeTestUrl()), GetParam()));
  chain.StartAll();
  ASSERT_TRUE(chain.WaitForEnd());
  ExpectComplete(chain.read(), 400);
  chain.sensor().Stop();
  const ServiceStatus status = chain.sensor().runner().MakeStatus();
  EXPECT_GT(status.inputs[0].repairs + status.inputs[1].repairs, 0);
}

INSTANTIATE_TEST_SUITE_P(Share, LossyStream, testing::Values(0.05, 0.2));

TEST(Stream, WaitsForALateReceiverAndThenReachesItWhole) {
  Chain chain(OnUdp(MakeTestUrl()));
  chain.StartRobot();
  chain.StartSimulator();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  chain.StartSensor();
  ASSERT_TRUE(chain.WaitForEnd());
  ExpectComplete(chain.read(), 400);
}

TEST(Stream, ReachesAReceiverThatStartsAnewFromTheFirstMessage) {
  Chain chain(OnUdp(MakeTestUrl()));
  chain.StartAll();
  ASSERT_TRUE(chain.WaitForEnd());
  chain.KillSensor();
  chain.StartSensor();
  ASSERT_TRUE(chain.WaitForEnd());
  ExpectComplete(chain.read(), 400);
}

TEST(Stream, GoesOnWhenItsSenderStartsAnew) {
  Chain chain(OnUdp(MakeTestUrl()), 1500);
  chain.StartAll();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  chain.KillSimulator();
  chain.StartSimulator();
  ASSERT_TRUE(chain.WaitForEnd());
  ExpectComplete(chain.read(), 1500);
}

TEST(Stream, IsNotMixedWithThatOfAnotherPort) {
  Chain first(OnUdp(MakeTestUrl()), 300);
  Chain second(OnUdp(MakeTestUrl()), 500);
  first.StartAll();
  second.StartAll();
  ASSERT_TRUE(first.WaitForEnd());
  ASSERT_TRUE(second.WaitForEnd());
  ExpectComplete(first.read(), 300);
  ExpectComplete(second.read(), 500);
  first.sensor().Stop();
  EXPECT_EQ(first.sensor().runner().MakeStatus().inputs[0].refused, 0);
}

}  // namespace
}  // namespace nbs
