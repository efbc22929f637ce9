#include "sim/surface_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

TEST(SurfaceSamples, LieOnTheirTriangleWithItsNormal) {
  for (const SurfaceSample& sample : MakeSurfaceSamples(MakeSquare(0.1f, 0.3f), 1000)) {
    EXPECT_NEAR(sample.p_W.z(), 0.3, 1e-7);
    EXPECT_LE(sample.p_W.head<2>().cwiseAbs().maxCoeff(), 0.1 + 1e-7);
    EXPECT_NEAR(sample.normal_W.z(), 1.0, 1e-12);
  }
}

TEST(SurfaceSamples, AreEvenInAreaHoweverFineTheMesh) {
  // The same square again at z = 1, in many triangles.
  TriangleMesh mesh = MakeSquare(0.1f, 0.0f);
  constexpr uint32_t kStrips = 100;
  for (uint32_t i = 0; i <= kStrips; ++i) {
    const float x = 0.2f * static_cast<float>(i) / kStrips - 0.1f;
    mesh.vertices_W.insert(mesh.vertices_W.end(), {{x, -0.1f, 1.0f}, {x, 0.1f, 1.0f}});
  }
  for (uint32_t i = 0; i < kStrips; ++i) {
    const uint32_t v = 4 + 2 * i;
    mesh.triangles.push_back({v, v + 2, v + 1});
    mesh.triangles.push_back({v + 2, v + 3, v + 1});
  }
  const auto samples = MakeSurfaceSamples(mesh, 10000);
  const auto upper = std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.p_W.z() > 0.5; });
  EXPECT_NEAR(static_cast<double>(upper), 5000.0, 1.0);
}

TEST(SurfaceSamples, NeedASurfaceAndACount) {
  EXPECT_THAT([] { MakeSurfaceSamples(TriangleMesh{}, 10); }, ::testing::Throws<std::invalid_argument>());
  EXPECT_THAT([] { MakeSurfaceSamples(MakeSquare(0.1f, 0.0f), 0); }, ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
