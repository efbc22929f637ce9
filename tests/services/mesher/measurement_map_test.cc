#include "services/mesher/measurement_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Eigen::Vector3f;

/// How exactly a sample's place is kept: half of a 65535th of a cell of 2 mm, and single precision.
constexpr float kPlace_m = 16e-9f;

void Insert(const Measurement& m, MeasurementMap& map) { map.Insert(m, m.view_W); }

std::vector<Sample> GatherAll(const MeasurementMap& map, const Vector3f& side_W) {
  std::vector<Sample> samples;
  map.Gather(Vector3f::Constant(0.001f), 0.01f, side_W, 0.1f, samples);
  return samples;
}

TEST(MeasurementMap, MeanIsWeightedByTheInverseVariance) {
  MeasurementMap map(0.002f);
  Insert({{0.0010f, 0.001f, 0.001f}, Vector3f::UnitZ(), 0.0001f}, map);
  Insert({{0.0015f, 0.001f, 0.001f}, Vector3f::UnitZ(), 0.0002f}, map);
  const auto samples = GatherAll(map, Vector3f::UnitZ());
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].p_W.x(), (4 * 0.0010 + 0.0015) / 5, 1e-7);
  EXPECT_EQ(samples[0].measurements, 2);
  EXPECT_NEAR(samples[0].weight, 125.0f, 1e-2);  // 1/mm^2
}

TEST(MeasurementMap, RoundingDoesNotAddUpOverManyMeasurements) {
  MeasurementMap map(0.002f);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr int kCount = 20'000;
  for (uint64_t n = 0; n < kCount; ++n) {
    const auto draw = [&](uint64_t axis) { return static_cast<float>(0.002 * CalcUniform({62, n, axis})); };
    const Vector3f p_W(draw(0), draw(1), draw(2));
    Insert({p_W, Vector3f::UnitZ(), 0.0001f}, map);
    sum += p_W.cast<double>();
  }
  const auto samples = GatherAll(map, Vector3f::UnitZ());
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_LT((samples[0].p_W.cast<double>() - sum / kCount).norm(), 1e-6);
}

TEST(MeasurementMap, OppositeSidesOfOneCellStayApart) {
  MeasurementMap map(0.002f);
  Insert({{0.001f, 0.001f, 0.0015f}, Vector3f::UnitZ(), 0.0001f}, map);
  Insert({{0.001f, 0.001f, 0.0005f}, -Vector3f::UnitZ(), 0.0001f}, map);
  const auto above = GatherAll(map, Vector3f::UnitZ());
  ASSERT_EQ(above.size(), 1u);
  EXPECT_NEAR(above[0].p_W.z(), 0.0015f, kPlace_m);
  EXPECT_NEAR(GatherAll(map, -Vector3f::UnitZ())[0].p_W.z(), 0.0005f, kPlace_m);
}

TEST(MeasurementMap, ViewsOfAKnownSideShareASample) {
  MeasurementMap map(0.002f);
  const Vector3f p_W = Vector3f::Constant(0.001f);
  map.Insert({p_W, Vector3f(0.8f, 0.0f, 0.6f), 0.0001f}, Vector3f::UnitZ());
  map.Insert({p_W, Vector3f(-0.8f, 0.0f, 0.6f), 0.0001f}, Vector3f::UnitZ());
  const auto samples = GatherAll(map, Vector3f::UnitZ());
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].measurements, 2);
  EXPECT_NEAR(samples[0].view_W.dot(Vector3f::UnitZ()), 0.6f, 1e-4f);  // The mean cosine.
}

TEST(MeasurementMap, GathersWhatASearchThroughAllPointsFinds) {
  MeasurementMap map(0.002f);
  std::vector<Vector3f> points;
  for (uint64_t n = 0; n < 3000; ++n) {
    const auto draw = [&](uint64_t axis) { return static_cast<float>(0.04 * CalcUniform({61, n, axis}) - 0.02); };
    const Vector3f cell(std::floor(draw(0) / 0.002f), std::floor(draw(1) / 0.002f), std::floor(draw(2) / 0.002f));
    points.emplace_back(0.002f * (cell + Vector3f::Constant(0.5f)));
    Insert({points.back(), Vector3f::UnitZ(), 0.0001f}, map);
  }
  for (uint64_t n = 0; n < 50; ++n) {
    const Vector3f p_W = points[n] + Vector3f(0.0003f, 0.0007f, -0.0004f);
    std::vector<Sample> samples;
    map.Gather(p_W, 0.005f, Vector3f::UnitZ(), 0.1f, samples);
    int gathered = 0;
    for (const Sample& s : samples) gathered += s.measurements;
    EXPECT_EQ(gathered, std::ranges::count_if(points, [&](const Vector3f& q) { return (q - p_W).norm() <= 0.005f; }));
  }
}

TEST(MeasurementMap, ForgetsWithinTheRadiusOnlyAndTakesUpThePlaceAgain) {
  MeasurementMap map(0.002f);
  const Measurement near{{0.001f, 0.001f, 0.001f}, Vector3f::UnitZ(), 0.0001f},
      far{{0.007f, 0.001f, 0.001f}, Vector3f::UnitX(), 0.0001f};
  for (int round = 0; round < 3; ++round) {
    Insert(near, map);
    Insert(far, map);
    map.Forget(Vector3f::Constant(0.001f), 0.003f);
    EXPECT_TRUE(GatherAll(map, Vector3f::UnitZ()).empty());
    EXPECT_EQ(GatherAll(map, Vector3f::UnitX())[0].measurements, round + 1);
  }
  map.Forget(Vector3f::Constant(0.001f), 0.01f);
  EXPECT_TRUE(GatherAll(map, Vector3f::UnitX()).empty());
}

TEST(MeasurementMap, SamplesBeyondTheRadiusAreLeftOut) {
  MeasurementMap map(0.002f);
  Insert({{0.0f, 0.0f, 0.0051f}, Vector3f::UnitZ(), 0.0001f}, map);
  Insert({{0.0f, 0.0f, 0.0049f}, Vector3f::UnitX(), 0.0001f}, map);
  std::vector<Sample> samples;
  map.Gather(Vector3f::Zero(), 0.005f, Vector3f(1, 0, 1).normalized(), 0.1f, samples);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].p_W.z(), 0.0049f, kPlace_m);
}

}  // namespace
}  // namespace nbs
