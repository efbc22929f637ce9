#include "common/bus/publisher.h"

#include <gtest/gtest.h>

#include "common/bus/window.h"

namespace nbs {
namespace {

using std::chrono::milliseconds;

// Messages of equal size whose first byte is their number.
class FakeStore : public MessageStore {
 public:
  FakeStore(int64_t count, size_t bytes) : count_(count), bytes_(bytes) {}
  int64_t size() const override { return count_; }
  std::vector<uint8_t> Read(int64_t seq) const override {
    return std::vector<uint8_t>(bytes_, static_cast<uint8_t>(seq));
  }
  int64_t utime_us(int64_t seq) const override { return 40000 * seq; }
  int64_t CalcKernelBytesBefore(int64_t seq) const override {
    return seq * static_cast<int64_t>(EstimateKernelBytes(bytes_));
  }
  void Grow(int64_t count) { count_ += count; }

 private:
  int64_t count_;
  size_t bytes_;
};

// Notes what is sent, as "CHANNEL number".
class NotingTransport : public Transport {
 public:
  void Subscribe(const std::string&) override {}
  void Publish(std::string_view channel, std::span<const uint8_t> data) override {
    sent_.push_back(std::string(channel) + " " + std::to_string(data[0]));
  }
  void Poll(std::chrono::microseconds, const Handler&) override {}
  void Wake() override {}
  std::vector<std::string> Take() { return std::exchange(sent_, {}); }

 private:
  std::vector<std::string> sent_;
};

constexpr size_t kBytes = 1000;
const auto kCost = static_cast<int64_t>(EstimateKernelBytes(kBytes));

ServiceStatus Received(const std::string& service, const std::string& channel, int64_t count) {
  ServiceStatus status;
  status.service = service;
  status.inputs.resize(1);
  status.inputs[0].channel = channel;
  status.inputs[0].received = count;
  return status;
}

class PublisherOfStripes : public testing::Test {
 protected:
  FakeStore store_{0, kBytes};
  Publisher publisher_{{{"STRIPE", &store_, {"mesher", "voxelmap"}}}, 3 * kCost, false};
  NotingTransport bus_;
  Instant now_ = Clock::now();

  std::vector<std::string> Send() {
    publisher_.Send(now_, bus_);
    return bus_.Take();
  }
};

using Sent = std::vector<std::string>;

TEST_F(PublisherOfStripes, StopsAtTheWindow) {
  store_.Grow(5);
  EXPECT_EQ(Send(), (Sent{"STRIPE 0", "STRIPE 1", "STRIPE 2"}));
  EXPECT_EQ(Send(), Sent{});
  EXPECT_EQ(publisher_.MakeStatus()[0].stalls, 1);
  EXPECT_EQ(publisher_.ledger().peak_bytes(), 3 * kCost);
}

TEST_F(PublisherOfStripes, WaitsForTheSlowestReceiverAndNamesIt) {
  store_.Grow(5);
  Send();
  publisher_.OnStatus(Received("mesher", "STRIPE", 3));
  EXPECT_EQ(Send(), Sent{});
  EXPECT_EQ(publisher_.MakeStatus()[0].waits_for, "voxelmap");
  publisher_.OnStatus(Received("voxelmap", "STRIPE", 1));
  EXPECT_EQ(Send(), Sent{"STRIPE 3"});
  EXPECT_EQ(publisher_.MakeStatus()[0].acknowledged, 1);
}

TEST_F(PublisherOfStripes, DoesNotTakeTheCreditOfStrangers) {
  store_.Grow(5);
  Send();
  publisher_.OnStatus(Received("planner", "STRIPE", 3));
  EXPECT_EQ(Send(), Sent{});
}

TEST_F(PublisherOfStripes, StaysWithinTheWindowWhenTimePasses) {
  store_.Grow(5);
  Send();
  now_ += milliseconds(500);
  EXPECT_EQ(Send(), Sent{});
}

TEST_F(PublisherOfStripes, AnswersARepairRequestBeforeLiveMessages) {
  store_.Grow(2);
  Send();
  store_.Grow(3);
  publisher_.OnRepairRequest({0, "mesher", "STRIPE", {1}});
  publisher_.OnStatus(Received("voxelmap", "STRIPE", 2));
  EXPECT_EQ(Send(), Sent{"STRIPE 1"});
  publisher_.OnStatus(Received("mesher", "STRIPE", 2));
  EXPECT_EQ(Send(), (Sent{"STRIPE 2", "STRIPE 3", "STRIPE 4"}));
}

TEST_F(PublisherOfStripes, KeepsRepairWithinTheWindowToo) {
  store_.Grow(3);
  Send();
  publisher_.OnStatus(Received("voxelmap", "STRIPE", 3));
  publisher_.OnStatus(Received("mesher", "STRIPE", 3));
  store_.Grow(3);
  Send();
  now_ += milliseconds(31);  // What nobody acknowledged no longer lies in a buffer.
  publisher_.OnRepairRequest({0, "mesher", "STRIPE", {0, 1, 2, 3, 4, 5}});
  EXPECT_EQ(Send(), (Sent{"STRIPE 0", "STRIPE 1", "STRIPE 2"}));
  EXPECT_EQ(Send(), Sent{});
  publisher_.OnStatus(Received("mesher", "STRIPE", 2));
  EXPECT_EQ(Send(), (Sent{"STRIPE 3", "STRIPE 4"}));
  EXPECT_EQ(publisher_.ledger().peak_bytes(), 3 * kCost);
}

TEST_F(PublisherOfStripes, AnswersANumberOnceThoughItIsAskedForTwice) {
  store_.Grow(2);
  Send();
  publisher_.OnRepairRequest({0, "mesher", "STRIPE", {0}});
  publisher_.OnRepairRequest({0, "voxelmap", "STRIPE", {0}});
  EXPECT_EQ(Send(), Sent{"STRIPE 0"});
}

TEST_F(PublisherOfStripes, PassesOverNumbersThatItHasNotPublished) {
  store_.Grow(5);
  Send();
  publisher_.OnRepairRequest({0, "mesher", "STRIPE", {-1, 3, 4, 1000000}});
  now_ += milliseconds(31);
  EXPECT_EQ(Send(), Sent{});
}

TEST(Publisher, TakesWhatTheHistoryHoldsForPublished) {
  const FakeStore store(4, kBytes);
  NotingTransport bus;
  Publisher publisher({{"STRIPE", &store, {"mesher"}}}, 3 * kCost, false);
  publisher.Send(Clock::now(), bus);
  EXPECT_EQ(bus.Take(), Sent{});
  EXPECT_EQ(publisher.MakeStatus()[0].published, 4);
}

TEST(Publisher, SendsAMessageLargerThanTheWindowAlone) {
  const FakeStore small(0, 100);
  FakeStore large(0, 60000);
  NotingTransport bus;
  Publisher publisher({{"PLAN", &large, {"coordinator"}}}, 16000, false);
  large.Grow(2);
  publisher.Send(Clock::now(), bus);
  EXPECT_EQ(bus.Take(), Sent{"PLAN 0"});
  publisher.OnStatus(Received("coordinator", "PLAN", 1));
  publisher.Send(Clock::now(), bus);
  EXPECT_EQ(bus.Take(), Sent{"PLAN 1"});
}

TEST(Publisher, WaitsForNobodyOnAStreamWithoutRequiredReceivers) {
  FakeStore store(0, kBytes);
  NotingTransport bus;
  Publisher publisher({{"STRIPE", &store, {}}}, 100 * kCost, false);
  store.Grow(50);
  publisher.Send(Clock::now(), bus);
  EXPECT_EQ(bus.Take().size(), 50u);
  EXPECT_TRUE(publisher.IsAllAcknowledged());
}

TEST(Publisher, LetsSimulatedTimeRunWithTheWallClockWhenPaced) {
  FakeStore store(0, kBytes);
  NotingTransport bus;
  Publisher publisher({{"ROBOT_STATE", &store, {}}}, 100 * kCost, true);
  store.Grow(5);
  const Instant start = Clock::now();
  publisher.Send(start, bus);
  EXPECT_EQ(bus.Take(), Sent{"ROBOT_STATE 0"});
  EXPECT_EQ(publisher.next_due(), start + milliseconds(40));
  publisher.Send(start + milliseconds(80), bus);
  EXPECT_EQ(bus.Take(), (Sent{"ROBOT_STATE 1", "ROBOT_STATE 2"}));
}

}  // namespace
}  // namespace nbs
