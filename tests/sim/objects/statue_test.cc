#include "sim/objects/statue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/coverage.h"
#include "sim/mesh_measures.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

class Statue : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { mesh_ = new TriangleMesh(MakeStatue()); }
  static void TearDownTestSuite() { delete mesh_; }
  static const TriangleMesh* mesh_;
};
const TriangleMesh* Statue::mesh_ = nullptr;

TEST_F(Statue, IsAClosedOutwardManifoldInOnePiece) {
  EXPECT_TRUE(IsClosedManifold(*mesh_));
  EXPECT_GT(CalcVolume(*mesh_), 0.003);
  EXPECT_EQ(KeepLargestPiece(*mesh_).triangles.size(), mesh_->triangles.size());
}

TEST_F(Statue, StandsOnTheOriginHalfAMetreHigh) {
  const Eigen::AlignedBox3d box = CalcBoundingBox(*mesh_);
  EXPECT_NEAR(box.min().z(), 0.0, 1e-6);
  EXPECT_NEAR(box.max().z(), 0.5, 1e-6);
  EXPECT_NEAR(box.center().x(), 0.0, 1e-6);
  EXPECT_NEAR(box.center().y(), 0.0, 1e-6);
}

TEST_F(Statue, HasAboutTwoHundredThousandTriangles) {
  EXPECT_GT(mesh_->triangles.size(), 190000u);
  EXPECT_LT(mesh_->triangles.size(), 215000u);
}

TEST_F(Statue, HasHardlyASliver) {
  size_t slivers = 0;
  for (const auto& t : mesh_->triangles) {
    double smallest = 180.0;
    for (int i = 0; i < 3; ++i) {
      const Vector3d a = mesh_->vertices_W[t[i]].cast<double>();
      const Vector3d u = mesh_->vertices_W[t[(i + 1) % 3]].cast<double>() - a;
      const Vector3d v = mesh_->vertices_W[t[(i + 2) % 3]].cast<double>() - a;
      smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi);
    }
    EXPECT_GT(smallest, 0.05);
    slivers += smallest < 15.0;
  }
  EXPECT_LT(slivers, mesh_->triangles.size() / 400);
}

TEST_F(Statue, NormalsAreOutwardUnitVectors) {
  ASSERT_EQ(mesh_->normals_W.size(), mesh_->vertices_W.size());
  for (const auto& n : mesh_->normals_W) EXPECT_NEAR(n.norm(), 1.0f, 1e-5f);
}

TEST_F(Statue, CanBeLookedThroughBetweenArmAndBodyAndBetweenTheLegs) {
  const TriangleScene scene(*mesh_);
  const auto open_at = [&scene](double x, double z) {
    return !scene.CastRay({{x, -1.0, z}, Vector3d::UnitY()}, 2.0).hit();
  };
  // A line along y that meets nothing, with the figure to its left and its right.
  const auto has_window = [&](double from_x, double to_x, double z) {
    bool closed = false, window = false;
    for (double x = from_x; x < to_x; x += 0.001) {
      const bool open = open_at(x, z);
      if (!open && window) return true;
      if (!open) closed = true;
      if (open && closed) window = true;
    }
    return false;
  };
  EXPECT_TRUE(has_window(0.03, 0.15, 0.23));
  EXPECT_TRUE(has_window(-0.05, 0.06, 0.09));
}

TEST_F(Statue, HidesLittleFromAFreeSensor) {
  CoverageSettings settings;
  settings.samples = 20000;
  const CoverageOracle oracle(*mesh_, settings);
  EXPECT_GT(oracle.observable_share(), 0.98);
  EXPECT_LT(oracle.observable_share(), 1.0);
}

TEST_F(Statue, IsTheSameOnEveryCall) {
  const TriangleMesh again = MakeStatue();
  EXPECT_EQ(again.vertices_W, mesh_->vertices_W);
  EXPECT_EQ(again.triangles, mesh_->triangles);
}

}  // namespace
}  // namespace nbs
