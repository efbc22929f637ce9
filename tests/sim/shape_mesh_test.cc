#include "sim/shape_mesh.h"

#include <gtest/gtest.h>

#include "common/kinematics/shape_distance.h"
#include "sim/mesh_measures.h"

namespace nbs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

TEST(Drawing, CapsuleIsDrawnAsItIsAndFacesOutwards) {
  const Capsule capsule{{0.1, 0, 0}, {0.1, 0.3, 0.2}, 0.05};
  Drawing drawing;
  drawing.Add(capsule, Vector3f(1, 0, 0));
  for (const Vector3f& p : drawing.mesh_W().vertices_W) {
    const Vector3d point = p.cast<double>();
    EXPECT_NEAR(CalcSegmentDistance(point, point, capsule.p_A, capsule.p_B), capsule.radius_m, 1e-6);
  }
  const double length = (capsule.p_B - capsule.p_A).norm();
  const double volume = M_PI * 0.05 * 0.05 * (length + 4.0 / 3.0 * 0.05);
  EXPECT_NEAR(CalcVolume(drawing.mesh_W()), volume, 0.02 * volume);
}

TEST(Drawing, BlockHasItsVolumeAndPartsKeepTheirColours) {
  Drawing drawing;
  drawing.Add(Capsule{Vector3d::Zero(), Vector3d::Zero(), 0.1}, Vector3f(1, 0, 0));
  const size_t first = drawing.mesh_W().vertices_W.size();
  const double ball = CalcVolume(drawing.mesh_W());
  drawing.Add(
      Block{MakePose({1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d::UnitX()))), {0.1, 0.2, 0.3}},
      Vector3f(0, 1, 0));
  EXPECT_NEAR(CalcVolume(drawing.mesh_W()) - ball, 0.048, 5e-4);
  EXPECT_EQ(drawing.surface().colors[first - 1], Vector3f(1, 0, 0));
  EXPECT_EQ(drawing.surface().colors[first], Vector3f(0, 1, 0));
  EXPECT_EQ(drawing.surface().openness.size(), drawing.mesh_W().vertices_W.size());
}

TEST(VoxelMesh, HasNoFacesBetweenVoxelsThatAreShown) {
  const GridShape grid{Vector3d(1, 2, 3), 0.1, Eigen::Vector3i(4, 4, 4)};
  const auto pair = [&](int64_t cell) { return cell == grid.Index(1, 1, 1) || cell == grid.Index(2, 1, 1); };
  const TriangleMesh mesh = MakeVoxelMesh(grid, pair);
  EXPECT_EQ(mesh.triangles.size(), 20u);
  EXPECT_NEAR(CalcVolume(mesh), 2e-3, 1e-6);
  const TriangleMesh all = MakeVoxelMesh(grid, [](int64_t) { return true; });
  EXPECT_EQ(all.triangles.size(), 6u * 16u * 2u);
  EXPECT_TRUE(CalcBoundingBox(all).isApprox(Eigen::AlignedBox3d(Vector3d(1, 2, 3), Vector3d(1.4, 2.4, 3.4)), 1e-6));
}

}  // namespace
}  // namespace nbs
