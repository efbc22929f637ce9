#include "services/mesher/small_parts.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

using Slots = std::vector<uint32_t>;

TEST(SmallParts, SingleFanHasNoLesserFans) {
  MeshTopology mesh;
  mesh.Insert({0, 1, 2}, 0);
  mesh.Insert({0, 2, 3}, 0);
  EXPECT_TRUE(FindLesserFans(mesh, 0).empty());
}

TEST(SmallParts, ClosedFanHasNoLesserFans) {
  MeshTopology mesh;
  mesh.Insert({0, 1, 2}, 0);
  mesh.Insert({0, 2, 3}, 0);
  mesh.Insert({0, 3, 1}, 0);
  EXPECT_TRUE(FindLesserFans(mesh, 0).empty());
}

TEST(SmallParts, SmallerOfTwoFansIsNamed) {
  MeshTopology mesh;
  const uint32_t lone = mesh.Insert({0, 8, 9}, 0);
  mesh.Insert({0, 1, 2}, 0);
  mesh.Insert({0, 2, 3}, 0);
  EXPECT_EQ(FindLesserFans(mesh, 0), (Slots{lone}));
}

TEST(SmallParts, OfEqualFansTheFirstSlotStays) {
  MeshTopology mesh;
  mesh.Insert({0, 1, 2}, 0);
  const uint32_t second = mesh.Insert({0, 4, 5}, 0);
  EXPECT_EQ(FindLesserFans(mesh, 0), (Slots{second}));
}

TEST(SmallParts, OpenFanBesideAClosedOneLeavesOneFan) {
  MeshTopology mesh;
  mesh.Insert({0, 1, 2}, 0);
  mesh.Insert({0, 2, 3}, 0);
  mesh.Insert({0, 3, 1}, 0);
  mesh.Insert({0, 4, 5}, 0);
  for (uint32_t slot : FindLesserFans(mesh, 0)) mesh.Remove(slot);
  EXPECT_TRUE(FindLesserFans(mesh, 0).empty());
}

TEST(SmallParts, PartIsFoundWholeOrUpToTheLimit) {
  MeshTopology mesh;
  for (uint32_t i = 0; i < 5; ++i)
    mesh.Insert(i % 2 == 0 ? MeshTopology::Triangle{i, i + 1, i + 2} : MeshTopology::Triangle{i + 1, i, i + 2}, 0);
  EXPECT_EQ(FindPart(mesh, 2, 6).size(), 5u);
  EXPECT_EQ(FindPart(mesh, 2, 5).size(), 5u);
  EXPECT_EQ(FindPart(mesh, 2, 3), (Slots{2, 1, 3}));
}

TEST(SmallParts, TouchInAVertexJoinsNoPart) {
  MeshTopology mesh;
  const uint32_t first = mesh.Insert({0, 1, 2}, 0);
  mesh.Insert({2, 3, 4}, 0);
  EXPECT_EQ(FindPart(mesh, first, 12), (Slots{first}));
}

}  // namespace
}  // namespace nbs
