#include <gtest/gtest.h>

#include <limits>

#include "tests/common/messages/random_message.h"

namespace nbs {
namespace {

const MessageHeader kHeader{42, 7, 0, "somebody"};

class EveryStreamDamaged : public testing::TestWithParam<size_t> {
 protected:
  std::mt19937_64 random_{GetParam() + 100};
};

TEST_P(EveryStreamDamaged, ATruncatedMessageIsRefusedAtEveryLength) {
  const auto bytes = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
  for (size_t length = 0; length < bytes.size(); ++length) {
    const Decoded decoded = Decode(GetParam(), std::span(bytes).first(length));
    EXPECT_FALSE(decoded.message.has_value()) << "at length " << length;
    EXPECT_FALSE(decoded.refusal.empty());
  }
}

TEST_P(EveryStreamDamaged, BytesLeftOverAreRefused) {
  auto bytes = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
  bytes.push_back(0);
  EXPECT_FALSE(Decode(GetParam(), bytes).message.has_value());
}

TEST_P(EveryStreamDamaged, AMutatedMessageIsRefusedOrIsOneThatASenderCouldHaveSent) {
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    auto bytes = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
    for (uint64_t changes = 1 + random_() % 4; changes > 0; --changes)
      bytes[random_() % bytes.size()] = static_cast<uint8_t>(random_());
    const Decoded decoded = Decode(GetParam(), bytes);
    if (!decoded.message.has_value()) continue;
    ++accepted;
    const auto header = DecodeHeader(bytes);
    ASSERT_TRUE(header.has_value());
    EXPECT_EQ(Encode(*header, *decoded.message), bytes);
  }
  EXPECT_GT(accepted, 0);
}

TEST_P(EveryStreamDamaged, RandomBytesBehindTheRightFingerprintDoNoHarm) {
  const auto sound = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<uint8_t> bytes(sound.begin(), sound.begin() + 45);
    bytes.resize(45 + random_() % 200);
    for (size_t i = 45; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(random_() % 4 == 0 ? random_() : 0);
    (void)Decode(GetParam(), bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Messages, EveryStreamDamaged, testing::Range(size_t{0}, std::variant_size_v<Message>));

std::string FindRefusal(const Message& message) { return Decode(message.index(), Encode(kHeader, message)).refusal; }

TEST(Refusal, APoseThatIsNotRigidIsNamed) {
  Stripe stripe;
  stripe.X_WS.linear() *= 1.1;
  EXPECT_EQ(FindRefusal(stripe), "X_WS is no rigid transform");
  stripe.X_WS = Pose::Identity();
  stripe.X_WS.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FindRefusal(stripe), "X_WS is no rigid transform");
}

TEST(Refusal, AStripesRangeThatIsNegativeIsNamed) {
  Stripe stripe;
  stripe.ranges_m = {0.3f, -0.1f};
  EXPECT_EQ(FindRefusal(stripe), "a range is negative or not finite");
}

TEST(Refusal, ARawProfilePassesWithAnyRangesBecauseTheSensorJudgesThem) {
  Profile profile;
  profile.ranges_m = {std::numeric_limits<float>::quiet_NaN(), -1.0f};
  EXPECT_EQ(FindRefusal(profile), "");
}

TEST(Refusal, VoxelRunsThatOverlapAreNamed) {
  const VoxelDelta delta{0, 0, false, {5, 6}, {2, 1}, {1, 2, 3}};
  EXPECT_EQ(FindRefusal(delta), "runs of voxels overlap or are out of order");
}

TEST(Refusal, VoxelRunsThatDoNotAddUpAreNamed) {
  const VoxelDelta delta{0, 0, false, {5}, {2}, {1, 2, 3}};
  EXPECT_EQ(FindRefusal(delta), "runs and values of voxels do not add up");
}

TEST(Refusal, AMeshSlotOutOfRangeIsNamed) {
  MeshDelta delta;
  delta.triangles.push_back({1u << 28, {0, 1, 2}});
  EXPECT_EQ(FindRefusal(delta), "a triangle is unsound");
}

TEST(Refusal, MoreJointsThanAnyArmHasAreNamed) {
  RobotState state;
  state.joints_rad.assign(8, 0.5);
  EXPECT_EQ(FindRefusal(state), "");
  state.joints_rad.push_back(0.5);
  EXPECT_EQ(FindRefusal(state), "a joint is not finite, or there are too many of them");
  Trajectory trajectory;
  trajectory.points.push_back({0, Pose::Identity(), state.joints_rad, false});
  EXPECT_EQ(FindRefusal(trajectory), "a point of the trajectory is unsound");
}

TEST(Refusal, AScanThatNoRunHasIsNamed) {
  PlanRequest request;
  request.scan = kMaxScans;
  EXPECT_EQ(FindRefusal(request), "");
  ++request.scan;
  EXPECT_EQ(FindRefusal(request), "the scan's number is negative or too high");
}

TEST(Refusal, AVertexKilometresAwayIsNamed) {
  MeshDelta delta;
  delta.vertices.push_back({.id = 0, .p_W = {1e4f, 0, 0}});
  EXPECT_EQ(FindRefusal(delta), "a vertex is unsound");
}

TEST(Refusal, ANegativeTimeIsNamed) {
  PlanRequest request;
  request.utime_us = -1;
  EXPECT_EQ(FindRefusal(request), "utime is negative");
}

TEST(Refusal, AnUnknownCodeIsNamed) {
  auto bytes = Encode(kHeader, PlanRequest{});
  bytes.back() = 4;
  EXPECT_EQ(Decode(StreamOf<PlanRequest>(), bytes).refusal, "unknown code 4");
}

TEST(Encoding, ANumberThatDoesNotFitItsFieldThrows) {
  MeshDelta delta;
  delta.triangles.push_back({0x80000000u, {0, 1, 2}});
  EXPECT_THROW(Encode(kHeader, delta), std::out_of_range);
}

}  // namespace
}  // namespace nbs
