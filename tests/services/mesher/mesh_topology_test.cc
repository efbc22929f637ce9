#include "services/mesher/mesh_topology.h"

#include <gtest/gtest.h>

#include "common/runtime/counter_random.h"
#include "tests/services/mesher/mesh_checks.h"

namespace nbs {
namespace {

TEST(MeshTopology, OneTriangleHasThreeBorderEdges) {
  MeshTopology mesh;
  EXPECT_NE(mesh.Insert({4, 5, 6}, 0), MeshTopology::kNone);
  EXPECT_EQ(mesh.triangle_count(), 1);
  EXPECT_EQ(mesh.edge_count(), 3);
  EXPECT_EQ(mesh.border_edge_count(), 3);
}

TEST(MeshTopology, TakenDirectedEdgeIsRefused) {
  MeshTopology mesh;
  mesh.Insert({0, 1, 2}, 0);
  EXPECT_EQ(mesh.Insert({1, 2, 3}, 0), MeshTopology::kNone);
  EXPECT_EQ(mesh.triangle_count(), 1);
}

TEST(MeshTopology, TriangleWithTwoEqualVerticesIsRefused) {
  MeshTopology mesh;
  EXPECT_EQ(mesh.Insert({0, 1, 1}, 0), MeshTopology::kNone);
}

TEST(MeshTopology, BorderRunsWithTheGapOnItsLeft) {
  MeshTopology mesh;
  mesh.Insert({0, 1, 2}, 0);
  std::vector<uint32_t> successors;
  mesh.FindBorderSuccessors(1, successors);
  EXPECT_EQ(successors, (std::vector<uint32_t>{0}));
}

TEST(MeshTopology, ChangedSlotsComeOnceAndAscending) {
  MeshTopology mesh;
  const uint32_t a = mesh.Insert({0, 1, 2}, 0);
  const uint32_t b = mesh.Insert({2, 1, 3}, 0);
  mesh.Remove(b);
  EXPECT_EQ(mesh.TakeChangedSlots(), (std::vector<uint32_t>{a, b}));
  EXPECT_TRUE(mesh.TakeChangedSlots().empty());
}

TEST(MeshTopology, BorderEdgesEqualThoseFromScratchAfterRandomChanges) {
  MeshTopology mesh;
  for (uint64_t step = 0; step < 2000; ++step) {
    const uint64_t bits = CalcRandomBits({4, step});
    if (bits % 2 != 0) {
      mesh.Insert({static_cast<uint32_t>(bits >> 8) % 12, static_cast<uint32_t>(bits >> 24) % 12,
                   static_cast<uint32_t>(bits >> 40) % 12},
                  0);
    } else if (!mesh.triangles().empty()) {
      const uint32_t slot = static_cast<uint32_t>(bits >> 8) % static_cast<uint32_t>(mesh.triangles().size());
      if (!mesh.IsEmpty(slot)) mesh.Remove(slot);
    }
    if (step % 7 != 0) continue;
    std::set<std::pair<uint32_t, uint32_t>> expected, given;
    for (uint32_t a = 0; a < 12; ++a) {
      for (uint32_t b = 0; b < 12; ++b) {
        if (mesh.Find(b, a) != MeshTopology::kNone && mesh.Find(a, b) == MeshTopology::kNone) expected.insert({a, b});
      }
    }
    mesh.ForEachBorderEdge([&](uint32_t a, uint32_t b) { EXPECT_TRUE(given.insert({a, b}).second); });
    ASSERT_EQ(given, expected);
  }
}

TEST(MeshTopology, CountsEqualThoseFromScratchAfterRandomChanges) {
  MeshTopology mesh;
  for (uint64_t step = 0; step < 4000; ++step) {
    const uint64_t bits = CalcRandomBits({3, step});
    if (bits % 3 != 0 || mesh.triangle_count() == 0) {
      mesh.Insert({static_cast<uint32_t>(bits >> 8) % 12, static_cast<uint32_t>(bits >> 24) % 12,
                   static_cast<uint32_t>(bits >> 40) % 12},
                  0);
    } else {
      const uint32_t slot = static_cast<uint32_t>(bits >> 8) % static_cast<uint32_t>(mesh.triangles().size());
      if (!mesh.IsEmpty(slot)) mesh.Remove(slot);
    }
    const MeshFigures figures = CountMesh(mesh.triangles(), [](uint32_t) { return Eigen::Vector3f::Zero(); });
    ASSERT_EQ(figures.doubled_edges, 0);
    ASSERT_EQ(figures.triangles, mesh.triangle_count());
    ASSERT_EQ(figures.edges, mesh.edge_count());
    ASSERT_EQ(figures.border_edges, mesh.border_edge_count());
  }
}

}  // namespace
}  // namespace nbs
