#include "sim/objects/isosurface.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/runtime/counter_random.h"
#include "sim/mesh_measures.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

const Eigen::AlignedBox3d kBox(Vector3d::Constant(-20.0), Vector3d::Constant(20.0));

Pose At(const Vector3d& p) {
  Pose X = Pose::Identity();
  X.translation() = p;
  return X;
}

TEST(MeshShape, BallHasItsAreaVolumeAndRadius) {
  SdfShape shape;
  shape.Add(Ellipsoid{Vector3d::Constant(10.0)}, At({0.3, -0.2, 0.1}), {});
  const TriangleMesh mesh = MeshShape(shape, kBox, {.spacing = 0.5});
  EXPECT_TRUE(IsClosedManifold(mesh));
  EXPECT_NEAR(CalcArea(mesh), 400.0 * std::numbers::pi, 3.0);
  EXPECT_NEAR(CalcVolume(mesh), 4000.0 / 3.0 * std::numbers::pi, 10.0);
  for (const auto& p : mesh.vertices_W) EXPECT_NEAR((p.cast<double>() - Vector3d(0.3, -0.2, 0.1)).norm(), 10.0, 1e-3);
}

TEST(MeshShape, TorusHasOneHandle) {
  SdfShape shape;
  shape.Add(Torus{10.0, 4.0}, At({0, 0, 0}), {});
  const TriangleMesh mesh = MeshShape(shape, kBox, {.spacing = 0.7});
  EXPECT_TRUE(IsClosedManifold(mesh));
  const auto vertices = static_cast<int64_t>(mesh.vertices_W.size());
  const auto triangles = static_cast<int64_t>(mesh.triangles.size());
  EXPECT_EQ(vertices - triangles / 2, 0);
}

TEST(MeshShape, IsAManifoldWhateverTouchesOrIsThinnerThanTheSamples) {
  for (uint64_t trial = 0; trial < 20; ++trial) {
    SdfShape shape;
    for (uint64_t i = 0; i < 40; ++i) {
      const Vector3d p(CalcUniform({trial, i, 0}), CalcUniform({trial, i, 1}), CalcUniform({trial, i, 2}));
      const Vector3d half_axes(0.3 + 4.0 * CalcUniform({trial, i, 3}), 0.3 + 4.0 * CalcUniform({trial, i, 4}), 0.3);
      shape.Add(Ellipsoid{half_axes}, At(24.0 * p - Vector3d::Constant(12.0)), {});
    }
    const TriangleMesh mesh = MeshShape(shape, kBox, {.spacing = 1.0});
    EXPECT_TRUE(IsClosedManifold(mesh)) << trial;
    EXPECT_GT(CalcVolume(mesh), 0.0);
  }
}

TEST(MeshShape, SameShapeGivesTheSameMesh) {
  SdfShape shape;
  shape.Add(Torus{10.0, 4.0}, At({0, 0, 0}), {.blend = 0.0, .ripple = 0.3, .ripple_size = 2.0});
  EXPECT_EQ(MeshShape(shape, kBox, {.spacing = 1.0}).vertices_W, MeshShape(shape, kBox, {.spacing = 1.0}).vertices_W);
}

}  // namespace
}  // namespace nbs
