// A whole run of all nodes in one process on a small object: a sphere of 40 mm with a bump.

#include "tests/whole/whole_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "sim/coverage.h"

namespace nbs {
namespace {

constexpr int kRings = 60, kSides = 90;

/// Radius over the direction: 40 mm, and a bump of 12 mm on one side.
double CalcRadius(double polar, double azimuth) {
  const double bump = std::exp(-4.0 * (std::pow(polar - 1.2, 2) + std::pow(azimuth - 2.0, 2)));
  return 0.040 + 0.012 * bump;
}

TriangleMesh MakeObject() {
  TriangleMesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const int sides = ring == 0 || ring == kRings ? 1 : kSides;
    for (int side = 0; side < sides; ++side) {
      const double polar = std::numbers::pi * ring / kRings, azimuth = 2.0 * std::numbers::pi * side / kSides;
      const double radius = sides == 1 ? 0.040 : CalcRadius(polar, azimuth);
      mesh.vertices_W.emplace_back(radius * std::sin(polar) * std::cos(azimuth),
                                   radius * std::sin(polar) * std::sin(azimuth), radius * std::cos(polar));
    }
  }
  const auto vertex = [](int ring, int side) -> uint32_t {
    if (ring == 0) return 0;
    if (ring == kRings) return 1 + (kRings - 1) * kSides;
    return 1 + (ring - 1) * kSides + side % kSides;
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int side = 0; side < kSides; ++side) {
      const uint32_t a = vertex(ring, side), b = vertex(ring + 1, side);
      const uint32_t c = vertex(ring + 1, side + 1), d = vertex(ring, side + 1);
      if (ring > 0) mesh.triangles.push_back({a, b, d});
      if (ring < kRings - 1) mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

RunConfig MakeConfig() {
  RunConfig config;
  config.cell = ReadCellConfig(NBS_SOURCE_DIR "/sim/cells/free.yaml");
  config.max_scans = 12;
  config.completeness = 0.995;
  return config;
}

/// One run, shared by the tests: it is the same whenever it is made.
const WholeRun& SharedRun() {
  static const WholeRun run = RunWhole(MakeConfig(), MakeObject(), {}, nullptr);
  return run;
}

TEST(WholeRun, EndsBecauseTheMeshIsComplete) {
  EXPECT_EQ(SharedRun().record.end_reason, "completeness_reached") << SharedRun().record.detail;
  EXPECT_FALSE(SharedRun().record.failed);
}

TEST(WholeRun, CoversTheObjectWithinTheNoise) {
  CoverageSettings settings;
  settings.samples = 20'000;
  const Coverage rated = CoverageOracle(MakeObject(), settings).Evaluate(SharedRun().mesh.MakeCompactMesh());
  EXPECT_GT(rated.coverage, 0.97);
  EXPECT_LT(rated.rmse_m, 3e-4);
}

TEST(WholeRun, NoEdgeHasMoreThanTwoTriangles) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : SharedRun().mesh.MakeCompactMesh().triangles) {
    for (int i = 0; i < 3; ++i) ++edges[std::minmax(t[i], t[(i + 1) % 3])];
  }
  ASSERT_FALSE(edges.empty());
  for (const auto& [edge, triangles] : edges) ASSERT_LE(triangles, 2);
}

TEST(WholeRun, TheSameRunTwiceIsTheSame) {
  const WholeRun again = RunWhole(MakeConfig(), MakeObject(), {}, nullptr);
  EXPECT_EQ(again.mesh.vertices(), SharedRun().mesh.vertices());
  EXPECT_EQ(again.mesh.triangles(), SharedRun().mesh.triangles());
  EXPECT_EQ(again.voxels, SharedRun().voxels);
}

TEST(WholeRun, AnotherSeedIsAnotherRun) {
  RunConfig config = MakeConfig();
  config.seed = 2;
  EXPECT_NE(RunWhole(config, MakeObject(), {}, nullptr).mesh.vertices(), SharedRun().mesh.vertices());
}

TEST(WholeRun, PrintsALineForEachScan) {
  std::ostringstream progress;
  RunConfig config = MakeConfig();
  config.max_scans = 2;
  const WholeRun run = RunWhole(config, MakeObject(), {}, &progress);
  EXPECT_EQ(std::ranges::count(progress.str(), '\n'), 1 + static_cast<int>(run.record.scans.size()));
}

}  // namespace
}  // namespace nbs
