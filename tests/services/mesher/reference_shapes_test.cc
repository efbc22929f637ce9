// Shapes with known answers, scanned from 60 directions at the profiler's default noise and harder.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "services/mesher/streaming_mesher.h"
#include "sim/mesh_measures.h"
#include "tests/services/mesher/mesh_quality.h"
#include "tests/services/mesher/shape_scan.h"
#include "tests/services/mesher/shapes.h"

namespace nbs {
namespace {

constexpr int kDirections = 60;
constexpr int kSamples = 20'000;
constexpr double kMaxEdge_m = TriangulationSettings{}.max_edge_m;

/// A shape, all of its surface scanned.
struct Exhaustive {
  explicit Exhaustive(const std::string& name, double noise = 1.0)
      : shape(MakeShapeByName(name)),
        scene_W(shape.mesh_W),
        profiler(MakeNoisier({}, noise)),
        sweeps(MakeSweepsFromDirections(shape.mesh_W, profiler, kDirections)),
        stripes(ScanMesh(scene_W, profiler, sweeps)),
        oracle(shape, profiler, stripes, kSamples) {}

  MeshQuality Evaluate(const std::vector<Stripe>& given) const { return oracle.Evaluate(Fold(profiler, given)); }

  static TriangleMesh Fold(const Profiler& profiler, const std::vector<Stripe>& stripes) {
    StreamingMesher mesher(profiler, {});
    MeshReplica replica;
    for (const Stripe& stripe : stripes) {
      EXPECT_TRUE(mesher.AddStripe(stripe));
      if (stripe.end_of_scan || stripe.index % 25 == 24) replica.Apply(mesher.TakeDelta());
    }
    return replica.MakeCompactMesh();
  }

  Shape shape;
  TriangleScene scene_W;
  Profiler profiler;
  std::vector<Sweep> sweeps;
  std::vector<Stripe> stripes;
  QualityOracle oracle;
};

void ExpectManifold(const MeshQuality& quality) {
  EXPECT_EQ(quality.non_manifold_edges, 0);
  EXPECT_EQ(quality.non_manifold_vertices, 0);
  EXPECT_EQ(quality.flipped_edges, 0);
  EXPECT_EQ(quality.degenerate_triangles, 0);
}

class SmoothShape : public testing::TestWithParam<const char*> {};

TEST_P(SmoothShape, IsMeshedCompletelyEvenlyAndBetterThanItIsMeasured) {
  const Exhaustive scan(GetParam());
  const MeshQuality quality = scan.Evaluate(scan.stripes);
  ExpectManifold(quality);
  EXPECT_GE(quality.completeness, 0.9995);
  EXPECT_GE(quality.measured, 0.999);
  EXPECT_GE(quality.coverage, 0.999);
  EXPECT_LE(quality.rms_error_m, 0.5 * CalcRangeSigma(scan.profiler, scan.profiler.standoff_m));
  EXPECT_NEAR(quality.mean_edge_m, 0.003, 0.00045);
  EXPECT_LE(quality.longest_edge_m, kMaxEdge_m);
}

TEST_P(SmoothShape, OneInAHundredMeasurementsOffIsNoHarm) {
  const Exhaustive scan(GetParam());
  std::vector<Stripe> stripes = scan.stripes;
  AddOutliers(scan.profiler, 0.01, 5, stripes);
  const MeshQuality quality = scan.Evaluate(stripes);
  ExpectManifold(quality);
  EXPECT_GE(quality.completeness, 0.995);
  EXPECT_GE(quality.coverage, 0.999);
  EXPECT_LE(quality.rms_error_m, 0.5 * CalcRangeSigma(scan.profiler, scan.profiler.standoff_m));
}

TEST_P(SmoothShape, ScansAMillimetreOffEachOtherGiveOneSheet) {
  Exhaustive scan(GetParam());
  DisplaceSweeps(0.001, 3, scan.sweeps);
  const TriangleMesh mesh_W = Exhaustive::Fold(scan.profiler, ScanMesh(scan.scene_W, scan.profiler, scan.sweeps));
  const MeshQuality quality = scan.oracle.Evaluate(mesh_W);
  ExpectManifold(quality);
  EXPECT_GE(quality.completeness, 0.995);
  EXPECT_GE(quality.coverage, 0.999);
  EXPECT_NEAR(CalcArea(mesh_W), CalcArea(scan.shape.mesh_W), 0.03 * CalcArea(scan.shape.mesh_W));
}

TEST_P(SmoothShape, AnyOrderOfTheStripesInAnyScansCoversTheSame) {
  const Exhaustive scan(GetParam());
  std::vector<Stripe> shuffled;
  for (const Stripe& stripe : scan.stripes) {
    if (!stripe.end_of_scan) shuffled.push_back(stripe);
  }
  for (size_t i = shuffled.size() - 1; i > 0; --i) std::swap(shuffled[i], shuffled[CalcRandomBits({17, i}) % (i + 1)]);
  std::vector<Stripe> stripes;
  Stripe closing;
  closing.end_of_scan = true;
  for (Stripe& stripe : shuffled) {
    stripe.scan = closing.scan;
    stripe.index = closing.index++;
    stripes.push_back(stripe);
    if (CalcUniform({18, stripes.size()}) > 0.01) continue;
    stripes.push_back(closing);
    ++closing.scan;
    closing.index = 0;
  }
  stripes.push_back(closing);
  const MeshQuality ordered = scan.Evaluate(scan.stripes), mixed = scan.Evaluate(stripes);
  ExpectManifold(mixed);
  EXPECT_NEAR(mixed.coverage, ordered.coverage, 0.001);
  EXPECT_GE(mixed.completeness, 0.9995);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SmoothShape, testing::Values("sphere", "torus"),
                         [](const auto& instance) { return std::string(instance.param); });

class SharpShape : public testing::TestWithParam<const char*> {};

TEST_P(SharpShape, IsMeshedWithinAMillimetreAlsoAtItsEdgesAndCorners) {
  const Exhaustive scan(GetParam());
  const TriangleMesh mesh_W = Exhaustive::Fold(scan.profiler, scan.stripes);
  const MeshQuality quality = scan.oracle.Evaluate(mesh_W);
  ExpectManifold(quality);
  EXPECT_GE(quality.completeness, 0.999);
  EXPECT_LE(quality.largest_error_m, 0.001);
  EXPECT_GT(quality.ridge_gap_m, 0.0);
  EXPECT_LE(quality.ridge_gap_m, 0.001);
  EXPECT_LE(quality.longest_edge_m, kMaxEdge_m);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SharpShape, testing::Values("cube", "brick"),
                         [](const auto& instance) { return std::string(instance.param); });

class Sheets : public testing::TestWithParam<std::tuple<const char*, double>> {};

TEST_P(Sheets, NoTriangleJoinsTwo) {
  const auto [name, noise] = GetParam();
  const Exhaustive scan(name, noise);
  const MeshQuality quality = scan.Evaluate(scan.stripes);
  ExpectManifold(quality);
  EXPECT_EQ(quality.joining_triangles, 0);
  EXPECT_GE(quality.coverage, 0.995);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Sheets,
                         testing::Values(std::tuple("plate", 1.0), std::tuple("plates", 1.0), std::tuple("cup", 1.0),
                                         std::tuple("plate", 4.0), std::tuple("plates", 4.0), std::tuple("cup", 4.0)),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param)) +
                                  (std::get<1>(instance.param) > 1.0 ? "NoiseTimesFour" : "");
                         });

}  // namespace
}  // namespace nbs
