#include "sim/coverage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

/// The sphere's triangles whose middle lies above the plane z = `height`.
TriangleMesh MakeCap(const TriangleMesh& sphere, float height) {
  TriangleMesh cap = sphere;
  std::erase_if(cap.triangles, [&sphere, height](const auto& t) {
    return sphere.vertices_W[t[0]].z() + sphere.vertices_W[t[1]].z() + sphere.vertices_W[t[2]].z() < 3.0f * height;
  });
  return cap;
}

TriangleMesh Scale(TriangleMesh mesh, float factor) {
  for (auto& p : mesh.vertices_W) p *= factor;
  return mesh;
}

TriangleMesh Flip(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

class SphereCoverage : public ::testing::Test {
 protected:
  const TriangleMesh sphere_ = MakeSphere(0.1f, 5);
  const CoverageOracle oracle_{sphere_, {}};
};

TEST_F(SphereCoverage, OfTheTruthItselfIsOne) {
  const Coverage result = oracle_.Evaluate(sphere_);
  EXPECT_EQ(result.coverage, 1.0);
  EXPECT_EQ(result.observable_coverage, 1.0);
  EXPECT_LT(result.rmse_m, 1e-9);
}

TEST_F(SphereCoverage, OfACapIsItsShareOfTheAreaPlusTheRim) {
  // A cap above z = h has (1 - h/r)/2 of the sphere's area; partners within 2 mm reach 2 mm farther down.
  for (const float height : {-0.05f, 0.0f, 0.06f}) {
    const double expected = 0.5 * (1.0 - height / 0.1);
    const double rim = 0.5 * 0.002 / 0.1;
    const double coverage = oracle_.Evaluate(MakeCap(sphere_, height)).coverage;
    EXPECT_GT(coverage, expected - 0.012) << height;
    EXPECT_LT(coverage, expected + rim + 0.012) << height;
  }
}

TEST_F(SphereCoverage, EndsWhereTheSurfaceIsTooFar) {
  EXPECT_GT(oracle_.Evaluate(Scale(sphere_, 1.018f)).coverage, 0.999);
  EXPECT_EQ(oracle_.Evaluate(Scale(sphere_, 1.022f)).coverage, 0.0);
}

TEST_F(SphereCoverage, OfASurfaceInsideOutIsNone) { EXPECT_EQ(oracle_.Evaluate(Flip(sphere_)).coverage, 0.0); }

TEST_F(SphereCoverage, RmseIsTheDistanceOfTheShell) {
  EXPECT_NEAR(oracle_.Evaluate(Scale(sphere_, 1.01f)).rmse_m, 0.001, 2e-5);
}

TEST_F(SphereCoverage, RmsePassesOverVerticesWithoutTriangle) {
  TriangleMesh mesh = sphere_;
  mesh.vertices_W.emplace_back(1.0f, 1.0f, 1.0f);
  EXPECT_LT(oracle_.Evaluate(mesh).rmse_m, 1e-9);
}

TEST_F(SphereCoverage, OfNothingIsZero) {
  const Coverage result = oracle_.Evaluate(TriangleMesh{});
  EXPECT_EQ(result.coverage, 0.0);
  EXPECT_EQ(result.rmse_m, 0.0);
}

TEST_F(SphereCoverage, IsTheSameOnEveryRun) {
  const CoverageOracle second(sphere_, {});
  const TriangleMesh cap = MakeCap(sphere_, 0.02f);
  EXPECT_EQ(oracle_.Evaluate(cap).coverage, second.Evaluate(cap).coverage);
}

TEST_F(SphereCoverage, EverythingOfAConvexBodyCanBeObserved) { EXPECT_EQ(oracle_.observable_share(), 1.0); }

TEST(ObservableShare, InsideOfASmallHollowBallCannotBeObserved) {
  // A shell: outer sphere of 100 mm, inner of 70 mm that faces inwards. The nearest depth, 150 mm, reaches through the
  // wall only.
  TriangleMesh shell = MakeSphere(0.1f, 4);
  const TriangleMesh inner = Flip(MakeSphere(0.07f, 4));
  const auto offset = static_cast<uint32_t>(shell.vertices_W.size());
  shell.vertices_W.insert(shell.vertices_W.end(), inner.vertices_W.begin(), inner.vertices_W.end());
  for (const auto& t : inner.triangles) shell.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const CoverageOracle oracle(shell, {});
  EXPECT_NEAR(oracle.observable_share(), 1.0 / (1.0 + 0.49), 0.003);
  const Coverage outer = oracle.Evaluate(MakeSphere(0.1f, 4));
  EXPECT_EQ(outer.observable_coverage, 1.0);
  EXPECT_NEAR(outer.coverage, oracle.observable_share(), 1e-9);
}

TEST(ObservableShare, TableHidesWhatLooksDown) {
  CoverageSettings settings;
  settings.table_z_m = -0.1;
  const CoverageOracle oracle(MakeSphere(0.1f, 5), settings);
  // A point at height z = r sin(a) above the equator of a sphere that stands on the table is seen from 150 mm away
  // within 70 degrees of its normal if a ray of elevation a + 70 degrees, or straight up, stays above the table: sin(a
  // + 70) 0.15 + r sin(a) >= -r.
  double lowest = -0.5 * std::numbers::pi;
  while (0.15 * std::sin(std::min(lowest + settings.profiler.max_incidence_rad, 0.5 * std::numbers::pi)) +
             0.1 * std::sin(lowest) <
         -0.1) {
    lowest += 1e-4;
  }
  EXPECT_NEAR(oracle.observable_share(), 0.5 * (1.0 - std::sin(lowest)), 0.0075);
  EXPECT_LT(oracle.observable_share(), 0.999);
}

TEST(CoverageOracle, RefusesATruthWithoutArea) {
  EXPECT_THAT([] { CoverageOracle(TriangleMesh{}, {}); }, ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
