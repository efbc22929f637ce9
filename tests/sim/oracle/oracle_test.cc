#include "sim/oracle/oracle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/mesh_measures.h"
#include "sim/oracle/oracle_json.h"
#include "sim/oracle/path_visibility.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

class SphereOracle : public ::testing::Test {
 protected:
  SphereOracle() {
    config_.cell.sensor_body_S = {{{0.0, 0.0, -0.04}, 0.04}};
    ResolvePlacement(CalcBoundingBox(sphere_), config_);
    settings_.paths.count = 60;
    settings_.coverage.samples = 4000;
  }
  OracleResult Run(int threads = 2) {
    settings_.threads = threads;
    return RunOracle(sphere_, config_, settings_, {});
  }

  const TriangleMesh sphere_ = MakeSphere(0.1f, 4);
  RunConfig config_;
  OracleSettings settings_;
};

TEST_F(SphereOracle, CoversASphereInAFewScans) {
  // One look at a sphere from 0.3 m, to 70 degrees of incidence, shows at most 26 % of it: (1 - cos(70° - asin(r sin
  // 70° / d))) / 2; a path along it somewhat more. So four scans at least, and no more than one would place by hand:
  // three around, one above, one below.
  const OracleResult result = Run();
  EXPECT_EQ(result.curves.size(), 8u);
  const auto reach = FindReach(result.curves[0], 0.98);
  ASSERT_TRUE(reach);
  EXPECT_GE(reach->scans, 4);
  EXPECT_LE(reach->scans, 6);
  EXPECT_NEAR(reach->path_length_m, result.curves[0].path_length_m.at(reach->scans - 1), 0.0);
}

TEST_F(SphereOracle, CurvesAreThoseOfTheirPaths) {
  const OracleResult result = Run();
  const TriangleScene scene(sphere_);
  const auto samples = MakeSurfaceSamples(sphere_, settings_.coverage.samples);
  const PathVisibility visibility(scene, samples, config_.cell.profiler);
  for (const OracleCurve& curve : result.curves) {
    if (curve.means != CoverMeans::kSeen) continue;
    std::vector<uint8_t> seen(samples.size(), 0);
    double length_m = 0.0;
    for (size_t i = 0; i < curve.paths.size(); ++i) {
      for (uint32_t sample : visibility.FindSeen(curve.paths[i])) seen[sample] = 1;
      length_m += curve.paths[i].length_m();
      const auto count = static_cast<double>(std::count(seen.begin(), seen.end(), 1));
      EXPECT_DOUBLE_EQ(curve.coverage[i], count / static_cast<double>(samples.size()));
      EXPECT_DOUBLE_EQ(curve.path_length_m[i], length_m);
    }
    EXPECT_DOUBLE_EQ(curve.coverage.back(), result.seen_by_any);
  }
}

TEST_F(SphereOracle, WithPartnersReachesBeyondWhatIsSeen) {
  settings_.coverage.max_distance_m = 0.01;
  const OracleResult result = Run();
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(result.curves[i].means, CoverMeans::kPartner);
    EXPECT_EQ(result.curves[i + 4].means, CoverMeans::kSeen);
    EXPECT_EQ(result.curves[i].rule, result.curves[i + 4].rule);
    EXPECT_GT(result.curves[i].coverage[0], result.curves[i + 4].coverage[0] + 0.01);
  }
}

TEST_F(SphereOracle, FromTheFirstPathBeginsWithTheCells) {
  for (const OracleCurve& curve : Run().curves) {
    EXPECT_EQ(curve.paths[0].X_WS_start.matrix() == config_.first_path.X_WS_start.matrix(), curve.from_first_path);
  }
}

TEST_F(SphereOracle, ByTheMetreNeedsLessPath) {
  const OracleResult result = Run();
  EXPECT_LT(FindReach(result.curves[1], 0.98)->path_length_m, FindReach(result.curves[0], 0.98)->path_length_m);
  EXPECT_GE(FindReach(result.curves[1], 0.98)->scans, FindReach(result.curves[0], 0.98)->scans);
}

TEST_F(SphereOracle, IsTheSameWithAnyNumberOfThreads) {
  EXPECT_EQ(MakeOracleJson(config_, settings_, Run(1)), MakeOracleJson(config_, settings_, Run(3)));
}

TEST_F(SphereOracle, JsonSaysWhenACoverageIsReached) {
  const OracleResult result = Run();
  const auto json = nlohmann::json::parse(MakeOracleJson(config_, settings_, result));
  EXPECT_EQ(json.at("paths"), 60);
  ASSERT_EQ(json.at("curves").size(), 8u);
  const auto& curve = json["curves"][0];
  EXPECT_EQ(curve.at("covered"), "partner");
  EXPECT_EQ(curve.at("rule"), "scan");
  EXPECT_EQ(curve.at("start"), "free");
  const auto& reached = curve.at("reached").at("95");
  const int scans = reached.at("scans");
  EXPECT_GE(curve.at("coverage").at(scans - 1), 0.95);
  EXPECT_LT(curve.at("coverage").at(scans - 2), 0.95);
  EXPECT_EQ(curve.at("path_length_m").at(scans - 1), reached.at("path_length_m"));
}

TEST(FindReach, OfWhatIsNeverReachedIsNothing) {
  OracleCurve curve;
  curve.coverage = {0.5, 0.9};
  curve.path_length_m = {1.0, 2.0};
  EXPECT_EQ(FindReach(curve, 0.9)->scans, 2);
  EXPECT_FALSE(FindReach(curve, 0.95));
}

TEST_F(SphereOracle, RefusesNoPathsAndNoThreads) {
  EXPECT_THAT([this] { Run(0); }, ::testing::Throws<std::invalid_argument>());
  settings_.paths.count = 0;
  EXPECT_THAT([this] { Run(1); }, ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
