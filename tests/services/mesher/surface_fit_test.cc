#include "services/mesher/surface_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Eigen::Vector3f;

/// Samples of z = height(x, y) on a raster of 1.4 mm x 2 mm about the origin, seen from above.
std::vector<Sample> SampleHeights(const std::function<double(double, double)>& height, double sigma_m) {
  std::vector<Sample> samples;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const double x = 0.0014 * i, y = 0.002 * j;
      const double z =
          height(x, y) + sigma_m * CalcGaussian({31, static_cast<uint64_t>(i + 10), static_cast<uint64_t>(j + 10)});
      samples.push_back(
          {Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)), Vector3f::UnitZ(), 16.0f, 1});
    }
  }
  return samples;
}

std::optional<SurfaceFit> FitFromScratch(const std::vector<Sample>& samples, const Vector3f& anchor_W) {
  const SurfaceFitSettings settings;
  const auto normal = EstimateNormal(samples, anchor_W, Vector3f::UnitZ(), settings);
  return normal ? FitSurface(samples, anchor_W, anchor_W, *normal, settings) : std::nullopt;
}

TEST(SurfaceFit, PlaneIsFoundExactly) {
  const auto fit =
      FitFromScratch(SampleHeights([](double x, double y) { return 0.3 * x - 0.2 * y; }, 0.0), Vector3f(0, 0, 0.0005f));
  ASSERT_TRUE(fit);
  const Vector3f normal = Vector3f(-0.3f, 0.2f, 1.0f).normalized();
  EXPECT_GT(fit->normal_W.dot(normal), 0.99999f);
  EXPECT_NEAR(fit->p_W.dot(normal), 0.0f, 2e-6f);
}

TEST(SurfaceFit, CurvedSurfaceIsNotFlattened) {
  const auto fit = FitFromScratch(SampleHeights([](double x, double y) { return -(x * x + y * y) / 0.03; }, 0.0),
                                  Vector3f::Zero());  // Radius 15 mm.
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->p_W.z(), 0.0f, 2e-5f);  // A plane through the samples would lie 0.1 mm below.
}

TEST(SurfaceFit, NoiseIsAveraged) {
  const auto fit = FitFromScratch(SampleHeights([](double, double) { return 0.0; }, 0.00026), Vector3f::Zero());
  ASSERT_TRUE(fit);
  EXPECT_LT(std::abs(fit->p_W.z()), 0.00015f);
  EXPECT_GT(fit->normal_W.z(), std::cos(0.08f));
}

TEST(SurfaceFit, OutlierDoesNotPull) {
  auto samples = SampleHeights([](double, double) { return 0.0; }, 0.0);
  samples[30].p_W.z() += 0.0038f;
  const auto fit = FitFromScratch(samples, Vector3f::Zero());
  ASSERT_TRUE(fit);
  EXPECT_LT(std::abs(fit->p_W.z()), 0.00005f);
}

TEST(SurfaceFit, TwoLayersAMillimetreApartAreAveraged) {
  auto samples = SampleHeights([](double, double) { return 0.0; }, 0.0);
  const auto upper = SampleHeights([](double, double) { return 0.001; }, 0.0);
  samples.insert(samples.end(), upper.begin(), upper.end());
  const auto fit = FitFromScratch(samples, Vector3f::Zero());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->p_W.z(), 0.0005f, 0.00005f);
}

TEST(SurfaceFit, OneStripeGivesNoNormal) {
  auto samples = SampleHeights([](double, double) { return 0.0; }, 0.00026);
  std::erase_if(samples, [](const Sample& s) { return s.p_W.y() != 0.0f; });
  for (Sample& s : samples) s.measurements = 5;
  EXPECT_FALSE(FitFromScratch(samples, Vector3f::Zero()));
}

TEST(SurfaceFit, TooFewMeasurementsGiveNoSurface) {
  auto samples = SampleHeights([](double, double) { return 0.0; }, 0.0);
  std::erase_if(samples, [](const Sample& s) { return s.p_W.norm() > 0.0017f; });
  EXPECT_FALSE(FitFromScratch(samples, Vector3f::Zero()));
}

TEST(SurfaceFit, ObliquelySeenSamplesCountByTheCosine) {
  auto samples = SampleHeights([](double, double) { return 0.0; }, 0.0);
  auto upper = SampleHeights([](double, double) { return 0.001; }, 0.0);
  for (Sample& s : upper) s.view_W = Vector3f(std::sqrt(0.75f), 0.0f, 0.5f);
  samples.insert(samples.end(), upper.begin(), upper.end());
  const auto fit = FitFromScratch(samples, Vector3f::Zero());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->p_W.z(), 0.001f / 3.0f, 0.00005f);
}

TEST(SurfaceFit, PointBesideASurfaceHasLittleWeightNear) {
  auto samples = SampleHeights([](double, double) { return 0.0; }, 0.0);
  const auto inside = FitFromScratch(samples, Vector3f::Zero());
  ASSERT_TRUE(inside);
  EXPECT_GT(inside->near_share, 0.5f);
  std::erase_if(samples, [](const Sample& s) { return s.p_W.x() > -0.0025f; });
  const auto rim = FitFromScratch(samples, Vector3f(-0.0028f, 0, 0));
  ASSERT_TRUE(rim);
  EXPECT_GT(rim->near_share, 0.5f);
  samples.push_back({Vector3f::Zero(), Vector3f::UnitZ(), 16.0f, 1});
  for (Sample& s : samples) s.measurements = 2;
  const auto beside = FitFromScratch(samples, Vector3f::Zero());
  ASSERT_TRUE(beside);
  EXPECT_LT(beside->near_share, 0.5f);
}

TEST(SurfaceFit, SurfaceThatPassesTheAnchorFarOffIsNone) {
  const auto samples = SampleHeights([](double, double) { return 0.0; }, 0.0);
  EXPECT_FALSE(FitSurface(samples, Vector3f(0, 0, 0.0045f), Vector3f(0, 0, 0.0f), Vector3f::UnitZ(), {}));
}

}  // namespace
}  // namespace nbs
