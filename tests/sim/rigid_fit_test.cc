#include "sim/rigid_fit.h"

#include <gtest/gtest.h>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

/// A potato of about 0.1 m, no turn of which is itself.
TriangleMesh MakePotato(int levels) {
  TriangleMesh mesh = MakeSphere(0.1f, levels);
  for (size_t v = 0; v < mesh.vertices_W.size(); ++v) {
    const Eigen::Vector3f& n = mesh.normals_W[v];
    mesh.vertices_W[v] *= 1.0f + 0.3f * n.x() * n.x() - 0.2f * n.y() * n.z() + 0.15f * n.z() * n.z() * n.x();
  }
  return mesh;
}

Pose MakeMotion() {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(0.0012, -0.0009, 0.0015);
  X.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  return X;
}

/// How far the pose moves the mesh's vertices at most.
double CalcFarthest(const TriangleMesh& mesh, const Pose& X) {
  double farthest_m = 0.0;
  for (const Eigen::Vector3f& p : mesh.vertices_W) {
    const Eigen::Vector3d p_W = p.cast<double>();
    farthest_m = std::max(farthest_m, (X * p_W - p_W).norm());
  }
  return farthest_m;
}

class RigidFit : public testing::Test {
 protected:
  const TriangleMesh model_ = MakePotato(4);  // Its vertices are vertices of the truth.
  const TriangleScene truth_{MakePotato(5)};
};

TEST_F(RigidFit, WhatLiesOnTheTruthStays) { EXPECT_LT(CalcFarthest(model_, FitRigid(model_, truth_)), 1e-6); }

TEST_F(RigidFit, BringsAMovedModelBack) {
  const Pose X = MakeMotion();
  EXPECT_GT(CalcFarthest(model_, X), 0.002);
  EXPECT_LT(CalcFarthest(model_, FitRigid(MoveMesh(model_, X), truth_) * X), 1e-5);
}

TEST_F(RigidFit, APartOfTheModelIsEnough) {
  TriangleMesh part = model_;
  std::erase_if(part.triangles, [&](const auto& t) { return model_.vertices_W[t[0]].z() < 0.0f; });
  const Pose X = MakeMotion();
  EXPECT_LT(CalcFarthest(model_, FitRigid(MoveMesh(part, X), truth_) * X), 1e-5);
}

TEST_F(RigidFit, AFewFarVerticesHardlyPull) {
  TriangleMesh model = MoveMesh(model_, MakeMotion());
  for (size_t v = 0; v < model.vertices_W.size(); v += 20) model.vertices_W[v].z() += 0.008f;
  EXPECT_LT(CalcFarthest(model_, FitRigid(model, truth_) * MakeMotion()), 2e-4);
}

TEST_F(RigidFit, WhatIsNowhereNearDoesNotMove) {
  Pose far = Pose::Identity();
  far.translation().x() = 1.0;
  EXPECT_EQ(FitRigid(MoveMesh(model_, far), truth_).matrix(), Pose::Identity().matrix());
  EXPECT_EQ(FitRigid({}, truth_).matrix(), Pose::Identity().matrix());
}

TEST(RigidFitOfASphere, ItsTurnsAreLeftAlone) {
  const TriangleMesh sphere = MakeSphere(0.1f, 4);
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(0.001, 0.001, -0.001);
  const Pose fit = FitRigid(MoveMesh(sphere, X), TriangleScene(MakeSphere(0.1f, 6)));
  EXPECT_LT((fit.translation() + X.translation()).norm(), 2e-5);
  EXPECT_LT(CalcAngleBetween(fit, Pose::Identity()), 1e-3);
}

TEST(MoveMesh, TurnsNormalsAndMovesVertices) {
  const Pose X = MakeMotion();
  const TriangleMesh sphere = MakeSphere(0.1f, 1), moved = MoveMesh(sphere, X);
  EXPECT_TRUE(moved.vertices_W[3].isApprox((X * sphere.vertices_W[3].cast<double>()).cast<float>()));
  EXPECT_TRUE(moved.normals_W[3].isApprox((X.linear() * sphere.normals_W[3].cast<double>()).cast<float>()));
}

}  // namespace
}  // namespace nbs
