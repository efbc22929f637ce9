#include "services/mesher/roof.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace nbs {
namespace {

using Eigen::Vector3f;

/// Tangents of the faces of the unit-normal cube whose corner is the origin and which fills x, y, z < 0: 3 x 3 on each
/// of the first `faces`, from `from_m` to from_m + 2 mm off the edges.
std::vector<Tangent> MakeCorner(int faces, float from_m) {
  std::vector<Tangent> tangents;
  for (int axis = 0; axis < faces; ++axis) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        Vector3f p_W = Vector3f::Zero();
        p_W[(axis + 1) % 3] = -from_m - 0.001f * static_cast<float>(i);
        p_W[(axis + 2) % 3] = -from_m - 0.001f * static_cast<float>(j);
        tangents.push_back({p_W, Vector3f::Unit(axis)});
      }
    }
  }
  return tangents;
}

const Vector3f kBelowCorner(-0.0005f, -0.0005f, -0.0005f);

TEST(Roof, ThreeFacesMeetInTheirCorner) {
  const auto roof = Roof::Fit(MakeCorner(3, 0.004f), kBelowCorner, {});
  ASSERT_TRUE(roof);
  const auto corner = roof->FindCorner();
  ASSERT_TRUE(corner);
  EXPECT_TRUE(corner->IsCorner());
  EXPECT_LT(corner->tangent.p_W.norm(), 1e-6f);
  EXPECT_LT((corner->tangent.normal_W - Vector3f::Ones().normalized()).norm(), 1e-5f);
}

TEST(Roof, FootOfARidgeLiesAcrossIt) {
  const auto roof = Roof::Fit(MakeCorner(2, 0.004f), kBelowCorner, {});
  ASSERT_TRUE(roof);
  EXPECT_FALSE(roof->FindCorner());
  const auto feet = roof->FindFeet({-0.001f, -0.0005f, -0.003f});
  ASSERT_EQ(feet.size(), 1u);
  EXPECT_LT((feet[0].tangent.p_W - Vector3f(0.0f, 0.0f, -0.003f)).norm(), 1e-6f);
  EXPECT_NEAR(std::abs(feet[0].along_W.z()), 1.0f, 1e-5f);
  EXPECT_LT((feet[0].tangent.normal_W - Vector3f(1.0f, 1.0f, 0.0f).normalized()).norm(), 1e-5f);
}

TEST(Roof, RidgeEndsWhereAThirdPlaneCutsItOff) {
  const auto roof = Roof::Fit(MakeCorner(3, 0.004f), kBelowCorner, {});
  ASSERT_TRUE(roof);
  EXPECT_EQ(roof->FindFeet({-0.001f, -0.001f, -0.001f}).size(), 3u);
  // Above the upper face only the feet on its own two edges are left.
  EXPECT_EQ(roof->FindFeet({-0.002f, -0.002f, 0.001f}).size(), 2u);
  EXPECT_FALSE(roof->IsOn({0.0f, 0.0f, 0.001f}));
  EXPECT_TRUE(roof->IsOn({0.0f, 0.0f, -0.001f}));
}

TEST(Roof, HeightIsThatAboveTheHighestPlane) {
  const auto roof = Roof::Fit(MakeCorner(3, 0.004f), kBelowCorner, {});
  ASSERT_TRUE(roof);
  EXPECT_NEAR(roof->CalcHeight({-0.001f, -0.0005f, -0.003f}), -0.0005f, 1e-6f);
  EXPECT_NEAR(roof->CalcHeight({-0.001f, 0.0002f, -0.003f}), 0.0002f, 1e-6f);
  const Tangent t = roof->Project({-0.001f, -0.0005f, -0.003f});
  EXPECT_LT((t.p_W - Vector3f(-0.001f, 0.0f, -0.003f)).norm(), 1e-6f);
  EXPECT_LT((t.normal_W - Vector3f::UnitY()).norm(), 1e-5f);
}

TEST(Roof, OnePlaneIsNone) { EXPECT_FALSE(Roof::Fit(MakeCorner(1, 0.004f), kBelowCorner, {})); }

TEST(Roof, InnerEdgeIsNone) {
  std::vector<Tangent> tangents = MakeCorner(2, 0.004f);
  for (Tangent& t : tangents) t.normal_W = -t.normal_W;
  EXPECT_FALSE(Roof::Fit(tangents, kBelowCorner, {}));
}

TEST(Roof, GentleBendIsNone) {
  std::vector<Tangent> tangents = MakeCorner(1, 0.004f);
  const Eigen::Matrix3f R = Eigen::AngleAxisf(0.6f, Vector3f::UnitZ()).toRotationMatrix();
  for (const Tangent& t : MakeCorner(1, 0.004f)) {
    const Vector3f mirrored(t.p_W.x(), -t.p_W.y(), t.p_W.z());
    tangents.push_back({R * mirrored, R * t.normal_W});
  }
  EXPECT_FALSE(Roof::Fit(tangents, kBelowCorner, {}));
}

TEST(Roof, TangentsOutOfReachDoNotCount) {
  RoofSettings settings;
  settings.reach_m = 0.004f;
  EXPECT_FALSE(Roof::Fit(MakeCorner(3, 0.004f), kBelowCorner, settings));
}

}  // namespace
}  // namespace nbs
