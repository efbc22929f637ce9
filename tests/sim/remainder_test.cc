#include "sim/remainder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

RemainderSettings MakeSettings() {
  RemainderSettings settings;
  settings.body_S = {{{0.0, 0.0, -0.04}, 0.04}};
  return settings;
}

Missing Classify(const TriangleMesh& truth, const SurfaceSample& sample, const RemainderSettings& settings) {
  CoverageSettings coverage;
  coverage.samples = 10;
  return RemainderExplainer(truth, CoverageOracle(truth, coverage), settings).Classify(sample);
}

TriangleMesh Flip(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// The sphere's triangles whose middle fulfils the condition.
template <typename Condition>
TriangleMesh Keep(TriangleMesh mesh, Condition condition) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const Eigen::Vector3f sum = mesh.vertices_W[t[0]] + mesh.vertices_W[t[1]] + mesh.vertices_W[t[2]];
    return !condition(sum.z() / 3.0f);
  });
  return mesh;
}

TEST(Missing, OnAFreeSurfaceIsOpen) {
  EXPECT_EQ(Classify(MakeSphere(0.1f, 4), {{0.0, 0.0, 0.1}, Vector3d::UnitZ()}, MakeSettings()), Missing::kOpen);
}

TEST(Missing, UnderAnObjectOnATableIsTheBase) {
  RemainderSettings settings = MakeSettings();
  const SurfaceSample lowest{{0.0, 0.0, -0.1}, -Vector3d::UnitZ()};
  EXPECT_EQ(Classify(MakeSphere(0.1f, 4), lowest, settings), Missing::kOpen);
  settings.table_z_m = -0.101;
  EXPECT_EQ(Classify(MakeSphere(0.1f, 4), lowest, settings), Missing::kBase);
}

TEST(Missing, InsideOfAHollowIsTooNarrowOrHidden) {
  const SurfaceSample in_70_mm{{0.0, 0.0, 0.07}, -Vector3d::UnitZ()};
  EXPECT_EQ(Classify(Flip(MakeSphere(0.07f, 4)), in_70_mm, MakeSettings()), Missing::kDepthOfField);
  const SurfaceSample in_10_mm{{0.0, 0.0, 0.01}, -Vector3d::UnitZ()};
  EXPECT_EQ(Classify(Flip(MakeSphere(0.01f, 4)), in_10_mm, MakeSettings()), Missing::kOccluded);
}

TEST(Missing, BetweenPlatesTheBodyHasNoRoom) {
  // 170 mm apart: a sight of 150 mm is free, but the body's middle, 190 mm away, keeps 60 mm from both plates only at
  // 55 degrees of incidence or more.
  TriangleMesh plates = MakeSquare(2.0f, 0.0f);
  const TriangleMesh above = Flip(MakeSquare(2.0f, 0.17f));
  plates.vertices_W.insert(plates.vertices_W.end(), above.vertices_W.begin(), above.vertices_W.end());
  for (const auto& t : above.triangles) plates.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  RemainderSettings settings = MakeSettings();
  const SurfaceSample sample{{0.01, 0.02, 0.0}, Vector3d::UnitZ()};
  settings.profiler.max_incidence_rad = 0.87;
  EXPECT_EQ(Classify(plates, sample, settings), Missing::kNoRoom);
  settings.profiler.max_incidence_rad = 1.15;
  EXPECT_EQ(Classify(plates, sample, settings), Missing::kOpen);
}

class SphereRemainder : public ::testing::Test {
 protected:
  SphereRemainder() { coverage_.samples = 20000; }
  Remainder Explain(const TriangleMesh& mesh, std::optional<double> table_z_m = std::nullopt) const {
    RemainderSettings settings = MakeSettings();
    settings.table_z_m = table_z_m;
    return RemainderExplainer(sphere_, CoverageOracle(sphere_, coverage_), settings).Explain(mesh);
  }

  const TriangleMesh sphere_ = MakeSphere(0.1f, 6);
  CoverageSettings coverage_;
};

TEST_F(SphereRemainder, OfTheTruthItselfIsNothing) {
  const Remainder remainder = Explain(sphere_);
  EXPECT_THAT(remainder.missing, ::testing::Each(0.0));
  EXPECT_THAT(remainder.rim_m, ::testing::Each(0.0));
  EXPECT_EQ(remainder.seam_m, 0.0);
}

TEST_F(SphereRemainder, OfACapIsTheRestAndItsRim) {
  const TriangleMesh cap = Keep(sphere_, [](float z) { return z > 0.0f; });
  const Remainder remainder = Explain(cap);
  EXPECT_NEAR(remainder.missing[0], 0.5, 0.02);
  EXPECT_DOUBLE_EQ(remainder.missing[0], 1.0 - CoverageOracle(sphere_, coverage_).Evaluate(cap).coverage);
  // The equator is an edge line of the octahedron.
  EXPECT_NEAR(remainder.rim_m[0], 2.0 * std::numbers::pi * 0.1, 0.002);
  EXPECT_EQ(remainder.seam_m, 0.0);
}

TEST_F(SphereRemainder, OnATableIsBaseBelow) {
  const Remainder remainder = Explain(Keep(sphere_, [](float z) { return z > 0.0f; }), -0.1);
  EXPECT_GT(remainder.missing[static_cast<size_t>(Missing::kBase)], 0.02);
  EXPECT_GT(remainder.missing[static_cast<size_t>(Missing::kOpen)], 0.1);
  EXPECT_NEAR(std::accumulate(remainder.missing.begin(), remainder.missing.end(), 0.0), 0.5, 0.02);
}

TEST_F(SphereRemainder, OfANarrowGapIsASeam) {
  const Remainder remainder = Explain(Keep(sphere_, [](float z) { return std::abs(z) > 0.001f; }));
  EXPECT_THAT(remainder.missing, ::testing::Each(0.0));
  EXPECT_THAT(remainder.rim_m, ::testing::Each(0.0));
  EXPECT_GT(remainder.seam_m, 2.0 * 2.0 * std::numbers::pi * 0.099);
}

}  // namespace
}  // namespace nbs
