#include <gtest/gtest.h>

#include <algorithm>

#include "tests/common/messages/random_message.h"

namespace nbs {
namespace {

void ExpectPiecesFit(const std::vector<Message>& pieces) {
  ASSERT_FALSE(pieces.empty());
  for (const Message& piece : pieces) {
    const auto bytes = Encode({1, 2, 0, std::string(64, 's')}, piece);
    EXPECT_LE(bytes.size(), kMaxMessageBytes);
    EXPECT_TRUE(Decode(piece.index(), bytes).message.has_value());
  }
}

TEST(Splitting, ASmallMessageComesBackAloneAndUnchanged) {
  std::mt19937_64 random(1);
  for (size_t stream = 0; stream < std::variant_size_v<Message>; ++stream) {
    const Message message = MakeRandomMessage(stream, random);
    const auto pieces = SplitForBus(message);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(Encode({}, pieces[0]), Encode({}, message));
  }
}

TEST(Splitting, PiecesOfAMeshDeltaMakeTheSameMesh) {
  std::mt19937_64 random(2);
  for (const auto& [vertices, triangles] : {std::pair{5000, 9000}, {1245, 1}, {1246, 0}, {0, 5000}, {2492, 3738}}) {
    MeshDelta whole = MakeRandomMeshDelta(random, static_cast<size_t>(vertices), static_cast<size_t>(triangles));
    whole.end_of_scan = true;
    const auto pieces = SplitForBus(whole);
    ExpectPiecesFit(pieces);
    // Random triangles name any slot of the first million.
    MeshReplica at_once;
    at_once.Apply({0, 0, false, {{.id = (1u << 20) - 1}}, {}});
    MeshReplica by_pieces = at_once;
    at_once.Apply(whole);
    for (const Message& piece : pieces) {
      const auto& delta = std::get<MeshDelta>(piece);
      by_pieces.Apply(delta);
      EXPECT_EQ(delta.end_of_scan, &piece == &pieces.back());
      EXPECT_EQ(delta.scan, whole.scan);
      EXPECT_EQ(delta.utime_us, whole.utime_us);
    }
    EXPECT_EQ(by_pieces.vertices(), at_once.vertices());
    EXPECT_EQ(by_pieces.triangles(), at_once.triangles());
  }
}

TEST(Splitting, APlanOfTheMostPointsIsOneMessage) {
  for (const size_t joints : {0, 6, 8}) {
    Plan plan;
    plan.found = true;
    plan.trajectory.points.assign(CalcMostPoints(joints), {0, Pose::Identity(), std::vector<double>(joints), false});
    ExpectPiecesFit(SplitForBus(plan));
    plan.trajectory.points.resize(plan.trajectory.points.size() + 5, plan.trajectory.points.front());
    EXPECT_THROW(SplitForBus(plan), std::invalid_argument) << "as many as there is room for";
  }
}

TEST(Splitting, AVertexNeverComesAfterATriangleThatUsesIt) {
  std::mt19937_64 random(3);
  const auto pieces = SplitForBus(MakeRandomMeshDelta(random, 3000, 3000));
  bool triangles_begun = false;
  for (const Message& piece : pieces) {
    const auto& delta = std::get<MeshDelta>(piece);
    EXPECT_FALSE(triangles_begun && !delta.vertices.empty());
    triangles_begun = triangles_begun || !delta.triangles.empty();
  }
}

std::vector<std::pair<uint32_t, int16_t>> ListCells(const VoxelDelta& delta) {
  std::vector<std::pair<uint32_t, int16_t>> cells;
  size_t value = 0;
  for (size_t run = 0; run < delta.run_start.size(); ++run) {
    for (uint32_t k = 0; k < delta.run_length[run]; ++k)
      cells.emplace_back(delta.run_start[run] + k, delta.values[value++]);
  }
  return cells;
}

TEST(Splitting, PiecesOfAVoxelDeltaSetTheSameCellsInTheSameOrder) {
  std::mt19937_64 random(4);
  for (const auto& [runs, longest] : {std::pair{20000, 6}, {4, 65535}, {7000, 1}, {1, 65535}}) {
    VoxelDelta whole = MakeRandomVoxelDelta(random, static_cast<size_t>(runs), longest);
    whole.end_of_scan = true;
    const auto pieces = SplitForBus(whole);
    ExpectPiecesFit(pieces);
    std::vector<std::pair<uint32_t, int16_t>> cells;
    for (const Message& piece : pieces) {
      const auto& delta = std::get<VoxelDelta>(piece);
      std::ranges::copy(ListCells(delta), std::back_inserter(cells));
      EXPECT_EQ(delta.end_of_scan, &piece == &pieces.back());
    }
    EXPECT_EQ(cells, ListCells(whole));
  }
}

TEST(Splitting, PiecesOfACandidateSetListTheSameCandidatesAndEndOnce) {
  std::mt19937_64 random(5);
  CandidateSet whole = MakeRandomCandidateSet(random, 1000);
  whole.end = true;
  const auto pieces = SplitForBus(whole);
  ExpectPiecesFit(pieces);
  EXPECT_GT(pieces.size(), 1u);
  CandidateSet together{whole.utime_us, whole.scan, true, {}};
  for (const Message& piece : pieces) {
    const auto& set = std::get<CandidateSet>(piece);
    std::ranges::copy(set.candidates, std::back_inserter(together.candidates));
    EXPECT_EQ(set.end, &piece == &pieces.back());
  }
  EXPECT_EQ(Encode({}, together), Encode({}, whole));
}

TEST(Splitting, ALargeMessageThatCannotBeCutThrows) {
  Profile profile;
  profile.ranges_m.resize(20000);
  EXPECT_THROW(SplitForBus(profile), std::invalid_argument);
}

TEST(Splitting, AProfileOf1280PointsFitsOneDatagram) {
  Stripe stripe;
  stripe.ranges_m.resize(1280, 0.3f);
  EXPECT_EQ(SplitForBus(stripe).size(), 1u);
}

}  // namespace
}  // namespace nbs
