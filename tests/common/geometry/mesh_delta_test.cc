#include "common/geometry/mesh_delta.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

namespace nbs {
namespace {

MeshDelta MakeDelta(const std::vector<uint32_t>& vertices, std::vector<MeshTriangle> triangles) {
  MeshDelta delta;
  for (uint32_t id : vertices) delta.vertices.push_back({.id = id, .measurements = 1});
  delta.triangles = std::move(triangles);
  return delta;
}

/// One triangle.
MeshDelta MakeCorner() { return MakeDelta({0, 1, 2}, {{0, {0, 1, 2}}}); }

void ExpectRefusedUnharmed(const MeshDelta& damaged) {
  MeshReplica replica;
  replica.Apply(MakeCorner());
  const MeshReplica before = replica;
  EXPECT_THROW(replica.Apply(damaged), std::invalid_argument);
  EXPECT_EQ(replica.vertices(), before.vertices());
  EXPECT_EQ(replica.triangles(), before.triangles());
}

TEST(MeshReplica, TriangleThatNamesAVertexNotThereIsRefused) {
  ExpectRefusedUnharmed(MakeDelta({}, {{0, {2, 1, 0}}, {1, {0, 1, 3}}}));
  ExpectRefusedUnharmed(MakeDelta({3}, {{1, {0, 3, 4}}}));
  ExpectRefusedUnharmed(MakeDelta({}, {{1, {kMaxSlots - 1, 1, 2}}}));
}

TEST(MeshReplica, TriangleMayNameAVertexOfTheSameDeltaAndOneOfAnEarlierDelta) {
  MeshReplica replica;
  replica.Apply(MakeCorner());
  replica.Apply(MakeDelta({3}, {{1, {0, 2, 3}}}));
  EXPECT_EQ(replica.MakeCompactMesh().triangles.size(), 2u);
}

TEST(MeshReplica, EmptySlotMayNameAnything) {
  MeshReplica replica;
  replica.Apply(MakeDelta({}, {{0, {7, 7, 7}}}));
  EXPECT_TRUE(replica.MakeCompactMesh().triangles.empty());
}

TEST(MeshReplica, SlotFarBeyondTheLastOneIsRefused) {
  ExpectRefusedUnharmed(MakeDelta({1, kMaxSlots - 1}, {}));
  ExpectRefusedUnharmed(MakeDelta({3 + 1 + kMaxSlotGap}, {}));
  ExpectRefusedUnharmed(MakeDelta({}, {{kMaxSlots - 1, {0, 1, 2}}}));
  ExpectRefusedUnharmed(MakeDelta({}, {{kMaxSlots, {0, 0, 0}}}));
}

TEST(MeshReplica, SlotsMayBeLeftOut) {
  MeshReplica replica;
  replica.Apply(MakeCorner());
  replica.Apply(MakeDelta({3 + kMaxSlotGap}, {}));
  EXPECT_EQ(replica.vertices().size(), size_t{4} + kMaxSlotGap);
  EXPECT_EQ(replica.vertices()[3].measurements, 0);
}

}  // namespace
}  // namespace nbs
