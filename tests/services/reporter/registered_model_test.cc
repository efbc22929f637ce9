#include "services/reporter/registered_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

/// Ten stripes of a scan and the one that closes it.
std::vector<Stripe> MakeReported() {
  std::vector<Stripe> stripes(11);
  for (int32_t i = 0; i < 11; ++i) stripes[i].index = i;
  stripes.back().end_of_scan = true;
  return stripes;
}

/// Each moved by as many tenths of a millimetre as its number; and a mesh of one triangle.
RegisteredStreams MakeRegistered() {
  RegisteredStreams registered;
  registered.stripes = MakeReported();
  for (Stripe& stripe : registered.stripes) stripe.X_WS.translation().y() += 1e-4 * stripe.index;
  MeshDelta delta;
  for (uint32_t i = 0; i < 3; ++i)
    delta.vertices.push_back({i, Eigen::Vector3f::Unit(i), Eigen::Vector3f::UnitZ(), 0.0f, 0.0f, 1, 0, 0});
  delta.triangles.push_back({0, {0, 1, 2}});
  registered.deltas = {delta};
  registered.figures.resize(1);
  registered.figures[0].completeness = 0.75;
  return registered;
}

TEST(RegisteredModel, MeasuresHowFarStripesWereMoved) {
  const auto model = MakeRegisteredModel(MakeRegistered(), MakeReported(), {});
  ASSERT_TRUE(model);
  EXPECT_NEAR(model->registration.mean_correction_m, 0.45e-3, 1e-12);  // The closing stripe's does not count.
  EXPECT_NEAR(model->registration.largest_correction_m, 0.9e-3, 1e-12);
  EXPECT_EQ(model->registration.figures.completeness, 0.75);
  EXPECT_FALSE(model->registration.evaluation);
}

TEST(RegisteredModel, ItsMeshIsTheOneThatIsRated) {
  const auto model = MakeRegisteredModel(MakeRegistered(), MakeReported(), [](const TriangleMesh& mesh_W) {
    return Evaluation{0.5, 0.25 * static_cast<double>(mesh_W.triangles.size()), 0.001};
  });
  EXPECT_EQ(model->mesh.MakeCompactMesh().vertices_W.size(), 3u);
  EXPECT_EQ(model->registration.evaluation.value().observable_coverage, 0.25);
}

TEST(RegisteredModel, TheRunMayHaveMoreStripes) {
  std::vector<Stripe> reported = MakeReported();
  reported.emplace_back().scan = 1;  // Of a scan that was cut short.
  EXPECT_TRUE(MakeRegisteredModel(MakeRegistered(), reported, {}));
}

TEST(RegisteredModel, RefusesTheStripesOfAnotherRun) {
  std::vector<Stripe> reported = MakeReported();
  reported[3].scan = 1;
  EXPECT_THROW(MakeRegisteredModel(MakeRegistered(), reported, {}), RunFailure);
  reported.resize(3);
  EXPECT_THROW(MakeRegisteredModel(MakeRegistered(), reported, {}), RunFailure);
}

TEST(RegisteredModel, ThereIsNoneWithoutRegistration) { EXPECT_FALSE(MakeRegisteredModel({}, MakeReported(), {})); }

TEST(RegisteredModel, IsToldBesideWhatWasStreamed) {
  Registration registration;
  registration.mean_correction_m = 0.6e-3;
  registration.largest_correction_m = 1.2e-3;
  RunRecord record;
  EXPECT_EQ(DescribeRegistration(registration, record),
            "scans registered with each other: moved by 0.60 mm in the mean, 1.20 mm at most");
  registration.evaluation = Evaluation{0.95, 0.97, 0.001};
  record.scans.resize(1);
  record.scans[0].evaluation = Evaluation{0.94, 0.96, 0.001};
  EXPECT_THAT(DescribeRegistration(registration, record),
              testing::HasSubstr(
                  "coverage 95.00 % (as streamed, up to scan 1: 94.00 %), of what can be seen 97.00 % (96.00 %)"));
}

}  // namespace
}  // namespace nbs
