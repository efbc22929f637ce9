// A whole run of all nodes in one process on a small object.

#include "tests/whole/whole_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "sim/coverage.h"
#include "tests/whole/small_object.h"

namespace nbs {
namespace {

RunConfig MakeConfig() {
  RunConfig config;
  config.cell = ReadCellConfig(NBS_SOURCE_DIR "/sim/cells/free.yaml");
  config.max_scans = 12;
  config.completeness = 0.995;
  return config;
}

/// One run, shared by the tests: it is the same whenever it is made.
const WholeRun& SharedRun() {
  static const WholeRun run = RunWhole(MakeConfig(), MakeSmallObject(), {}, nullptr);
  return run;
}

TEST(WholeRun, EndsBecauseTheMeshIsComplete) {
  EXPECT_EQ(SharedRun().record.end_reason, "completeness_reached") << SharedRun().record.detail;
  EXPECT_FALSE(SharedRun().record.failed);
}

TEST(WholeRun, CoversTheObjectWithinTheNoise) {
  CoverageSettings settings;
  settings.samples = 20'000;
  const Coverage rated = CoverageOracle(MakeSmallObject(), settings).Evaluate(SharedRun().mesh.MakeCompactMesh());
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
  const WholeRun again = RunWhole(MakeConfig(), MakeSmallObject(), {}, nullptr);
  EXPECT_EQ(again.mesh.vertices(), SharedRun().mesh.vertices());
  EXPECT_EQ(again.mesh.triangles(), SharedRun().mesh.triangles());
  EXPECT_EQ(again.voxels, SharedRun().voxels);
}

TEST(WholeRun, AnotherSeedIsAnotherRun) {
  RunConfig config = MakeConfig();
  config.seed = 2;
  EXPECT_NE(RunWhole(config, MakeSmallObject(), {}, nullptr).mesh.vertices(), SharedRun().mesh.vertices());
}

TEST(WholeRun, PrintsALineForEachScan) {
  std::ostringstream progress;
  RunConfig config = MakeConfig();
  config.max_scans = 2;
  const WholeRun run = RunWhole(config, MakeSmallObject(), {}, &progress);
  EXPECT_EQ(std::ranges::count(progress.str(), '\n'), 1 + static_cast<int>(run.record.scans.size()));
}

}  // namespace
}  // namespace nbs
