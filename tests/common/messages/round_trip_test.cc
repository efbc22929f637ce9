#include <gtest/gtest.h>

#include "nbs_msgs/candidate_set_t.hpp"
#include "nbs_msgs/execution_t.hpp"
#include "nbs_msgs/mesh_delta_t.hpp"
#include "nbs_msgs/mesh_scan_t.hpp"
#include "nbs_msgs/plan_request_t.hpp"
#include "nbs_msgs/plan_t.hpp"
#include "nbs_msgs/plan_timing_t.hpp"
#include "nbs_msgs/profile_t.hpp"
#include "nbs_msgs/robot_state_t.hpp"
#include "nbs_msgs/run_state_t.hpp"
#include "nbs_msgs/stripe_t.hpp"
#include "nbs_msgs/trajectory_t.hpp"
#include "nbs_msgs/voxel_delta_t.hpp"
#include "tests/common/messages/random_message.h"

namespace nbs {
namespace {

constexpr size_t kStreams = std::variant_size_v<Message>;
const MessageHeader kHeader{42, 7, 0, "somebody"};

// The bytes that lcm-gen's own decoder and encoder make of a message; empty if the decoder does not read exactly all of
// it.
template <typename Generated>
std::vector<uint8_t> PassThroughGenerated(const std::vector<uint8_t>& bytes) {
  Generated generated{};
  if (generated.decode(bytes.data(), 0, static_cast<int>(bytes.size())) != static_cast<int>(bytes.size())) return {};
  std::vector<uint8_t> again(static_cast<size_t>(generated.getEncodedSize()));
  if (generated.encode(again.data(), 0, static_cast<int>(again.size())) != static_cast<int>(again.size())) return {};
  return again;
}

std::vector<uint8_t> PassThroughGenerated(size_t stream, const std::vector<uint8_t>& bytes) {
  using namespace nbs_msgs;
  if (stream == StreamOf<PlanRequest>()) return PassThroughGenerated<plan_request_t>(bytes);
  if (stream == StreamOf<Trajectory>()) return PassThroughGenerated<trajectory_t>(bytes);
  if (stream == StreamOf<RunState>()) return PassThroughGenerated<run_state_t>(bytes);
  if (stream == StreamOf<RobotState>()) return PassThroughGenerated<robot_state_t>(bytes);
  if (stream == StreamOf<Execution>()) return PassThroughGenerated<execution_t>(bytes);
  if (stream == StreamOf<Profile>()) return PassThroughGenerated<profile_t>(bytes);
  if (stream == StreamOf<Stripe>()) return PassThroughGenerated<stripe_t>(bytes);
  if (stream == StreamOf<MeshDelta>()) return PassThroughGenerated<mesh_delta_t>(bytes);
  if (stream == StreamOf<MeshScan>()) return PassThroughGenerated<mesh_scan_t>(bytes);
  if (stream == StreamOf<VoxelDelta>()) return PassThroughGenerated<voxel_delta_t>(bytes);
  if (stream == StreamOf<Plan>()) return PassThroughGenerated<plan_t>(bytes);
  if (stream == StreamOf<CandidateSet>()) return PassThroughGenerated<candidate_set_t>(bytes);
  return PassThroughGenerated<plan_timing_t>(bytes);
}

class EveryStream : public testing::TestWithParam<size_t> {
 protected:
  std::mt19937_64 random_{GetParam()};
};

TEST_P(EveryStream, DecodingAndEncodingAgainGivesTheSameBytes) {
  for (int i = 0; i < 200; ++i) {
    const auto bytes = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
    const Decoded decoded = Decode(GetParam(), bytes);
    ASSERT_TRUE(decoded.message.has_value()) << decoded.refusal;
    EXPECT_EQ(decoded.message->index(), GetParam());
    EXPECT_EQ(Encode(kHeader, *decoded.message), bytes);
  }
}

TEST_P(EveryStream, TheCodeOfLcmGenReadsAndWritesTheSameBytes) {
  for (int i = 0; i < 50; ++i) {
    const auto bytes = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
    EXPECT_EQ(PassThroughGenerated(GetParam(), bytes), bytes);
  }
}

TEST_P(EveryStream, AMessageIsRefusedOnAnyOtherStream) {
  const auto bytes = Encode(kHeader, MakeRandomMessage(GetParam(), random_));
  for (size_t other = 0; other <= kStreams; ++other) {
    if (other == GetParam()) continue;
    EXPECT_FALSE(Decode(other, bytes).message.has_value()) << other;
  }
}

INSTANTIATE_TEST_SUITE_P(Messages, EveryStream, testing::Range(size_t{0}, kStreams));

// Equality of decoded values where the types have it; the other types are held by the fields read through lcm-gen's
// code below.
template <typename T>
void ExpectEqualAfterRoundTrip() {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    const Message sent = MakeRandomMessage(StreamOf<T>(), random);
    const Decoded decoded = Decode(StreamOf<T>(), Encode(kHeader, sent));
    ASSERT_TRUE(decoded.message.has_value()) << decoded.refusal;
    EXPECT_EQ(std::get<T>(*decoded.message), std::get<T>(sent));
  }
}

TEST(RoundTrip, ProfileComesOutEqual) { ExpectEqualAfterRoundTrip<Profile>(); }
TEST(RoundTrip, MeshDeltaComesOutEqual) { ExpectEqualAfterRoundTrip<MeshDelta>(); }
TEST(RoundTrip, MeshScanComesOutEqual) { ExpectEqualAfterRoundTrip<MeshScan>(); }
TEST(RoundTrip, VoxelDeltaComesOutEqual) { ExpectEqualAfterRoundTrip<VoxelDelta>(); }

TEST(RoundTrip, PoseComesOutBitForBit) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 100; ++i) {
    const Message sent = MakeRandomMessage(StreamOf<Stripe>(), random);
    const Decoded decoded = Decode(StreamOf<Stripe>(), Encode(kHeader, sent));
    ASSERT_TRUE(decoded.message.has_value()) << decoded.refusal;
    EXPECT_EQ(std::get<Stripe>(*decoded.message).X_WS.matrix(), std::get<Stripe>(sent).X_WS.matrix());
  }
}

TEST(RoundTrip, FieldsOfMeshScanArriveUnderTheirNamesInLcmGensType) {
  const MeshScan scan{9, 1, 2, 3, 4, 5, 6, 7, 8, 0.25, 0.5};
  const auto bytes = Encode(kHeader, scan);
  nbs_msgs::mesh_scan_t m{};
  ASSERT_GT(m.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  EXPECT_EQ(m.header.run, 42);
  EXPECT_EQ(m.header.seq, 7);
  EXPECT_EQ(m.header.utime_us, 9);
  EXPECT_EQ(m.header.source, "somebody");
  EXPECT_EQ(m.scan, 1);
  EXPECT_EQ(m.stripes, 2);
  EXPECT_EQ(m.points, 3);
  EXPECT_EQ(m.refused, 4);
  EXPECT_EQ(m.vertices, 5);
  EXPECT_EQ(m.triangles, 6);
  EXPECT_EQ(m.edges, 7);
  EXPECT_EQ(m.border_edges, 8);
  EXPECT_EQ(m.rim_length_m, 0.25);
  EXPECT_EQ(m.completeness, 0.5);
}

TEST(RoundTrip, PoseArrivesRowByRowInLcmGensType) {
  Stripe stripe;
  stripe.X_WS = MakePose({1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ())));
  const auto bytes = Encode(kHeader, stripe);
  nbs_msgs::stripe_t m{};
  ASSERT_GT(m.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  EXPECT_EQ(m.X_WS.position_m[1], 2.0);
  EXPECT_EQ(m.X_WS.rotation[1], stripe.X_WS.linear()(0, 1));
  EXPECT_EQ(m.X_WS.rotation[3], stripe.X_WS.linear()(1, 0));
}

TEST(RoundTrip, FieldsOfPlanArriveUnderTheirNamesInLcmGensType) {
  Plan plan;
  plan.scan = 4;
  plan.mode = PlanMode::kHole;
  plan.found = true;
  plan.chosen.candidate = {11, CandidateSource::kHole, 12, 13, {}};
  plan.chosen.gain_nat = 2.5;
  plan.chosen.verdict = Verdict::kPartly;
  plan.trajectory = {99, 4, {{100, Pose::Identity(), {0.5, 0.6}, true}}};
  const auto bytes = Encode(kHeader, plan);
  nbs_msgs::plan_t m{};
  ASSERT_GT(m.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  EXPECT_EQ(m.mode, int{nbs_msgs::plan_t::HOLE});
  EXPECT_EQ(m.found, 1);
  EXPECT_EQ(m.chosen.id, 11);
  EXPECT_EQ(m.chosen.source, int{nbs_msgs::rated_candidate_t::HOLE});
  EXPECT_EQ(m.chosen.born_scan, 12);
  EXPECT_EQ(m.chosen.rank, 13);
  EXPECT_EQ(m.chosen.gain_nat, 2.5);
  EXPECT_EQ(m.chosen.verdict, int{nbs_msgs::rated_candidate_t::PARTLY});
  EXPECT_EQ(m.trajectory_utime_us, 99);
  ASSERT_EQ(m.points.size(), 1u);
  EXPECT_EQ(m.points[0].time_us, 100);
  EXPECT_EQ(m.points[0].joints_rad, (std::vector<double>{0.5, 0.6}));
  EXPECT_EQ(m.points[0].scanning, 1);
}

}  // namespace
}  // namespace nbs
