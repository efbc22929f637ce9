#include "sim/mesh_measures.h"

#include <gtest/gtest.h>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

TEST(MeshMeasures, SphereHasItsAreaAndVolume) {
  const TriangleMesh sphere = MakeSphere(0.1f, 6);
  EXPECT_NEAR(CalcArea(sphere), 4.0 * std::numbers::pi * 0.01, 1e-4);
  EXPECT_NEAR(CalcVolume(sphere), 4.0 / 3.0 * std::numbers::pi * 0.001, 1e-5);
}

TEST(MeshMeasures, VolumeOfASphereInsideOutIsNegative) {
  TriangleMesh sphere = MakeSphere(0.1f, 3);
  for (auto& t : sphere.triangles) std::swap(t[0], t[1]);
  EXPECT_LT(CalcVolume(sphere), 0.0);
}

TEST(MeshMeasures, VertexNormalsOfASpherePointOutward) {
  const TriangleMesh sphere = MakeSphere(0.1f, 4);
  const auto normals = CalcVertexNormals(sphere);
  for (size_t v = 0; v < normals.size(); ++v) EXPECT_GT(normals[v].dot(sphere.normals_W[v]), 0.995f);
}

TEST(MeshMeasures, BoundingBoxOfNothingIsEmpty) { EXPECT_TRUE(CalcBoundingBox(TriangleMesh{}).isEmpty()); }

TEST(IsClosedManifold, HoldsForASphere) { EXPECT_TRUE(IsClosedManifold(MakeSphere(0.1f, 2))); }

TEST(IsClosedManifold, FailsWithATriangleMissing) {
  TriangleMesh sphere = MakeSphere(0.1f, 2);
  sphere.triangles.pop_back();
  EXPECT_FALSE(IsClosedManifold(sphere));
}

TEST(IsClosedManifold, FailsWithATriangleTurnedOver) {
  TriangleMesh sphere = MakeSphere(0.1f, 2);
  std::swap(sphere.triangles[5][0], sphere.triangles[5][1]);
  EXPECT_FALSE(IsClosedManifold(sphere));
}

/// Two tetrahedra that share vertex 0.
TriangleMesh MakeTwoTetrahedra() {
  TriangleMesh mesh;
  mesh.vertices_W = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  return mesh;
}

TEST(IsClosedManifold, FailsWhereTwoBodiesTouchInAVertex) { EXPECT_FALSE(IsClosedManifold(MakeTwoTetrahedra())); }

TEST(KeepLargestPiece, DropsTheOthersWithTheirVertices) {
  TriangleMesh mesh = MakeSphere(0.1f, 2);
  const size_t vertices = mesh.vertices_W.size(), triangles = mesh.triangles.size();
  const auto first = static_cast<uint32_t>(vertices);
  mesh.vertices_W.insert(mesh.vertices_W.begin(), {{9, 9, 9}, {9, 8, 9}, {8, 9, 9}});
  mesh.normals_W.insert(mesh.normals_W.begin(), 3, Eigen::Vector3f::UnitZ());
  for (auto& t : mesh.triangles) t = {t[0] + 3, t[1] + 3, t[2] + 3};
  mesh.triangles.push_back({0, 1, 2});
  const TriangleMesh piece = KeepLargestPiece(mesh);
  EXPECT_EQ(piece.triangles.size(), triangles);
  EXPECT_EQ(piece.vertices_W.size(), first);
  EXPECT_TRUE(IsClosedManifold(piece));
}

}  // namespace
}  // namespace nbs
