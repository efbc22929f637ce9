#include "services/mesher/measurement_map.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

using Eigen::Vector3f;

std::vector<Sample> GatherAll(const MeasurementMap& map, const Vector3f& side_W) {
  std::vector<Sample> samples;
  map.Gather(Vector3f::Constant(0.001f), 0.01f, side_W, 0.1f, samples);
  return samples;
}

TEST(MeasurementMap, MeanIsWeightedByTheInverseVariance) {
  MeasurementMap map(0.002f);
  map.Insert({{0.0010f, 0.001f, 0.001f}, Vector3f::UnitZ(), 0.0001f});
  map.Insert({{0.0015f, 0.001f, 0.001f}, Vector3f::UnitZ(), 0.0002f});
  const auto samples = GatherAll(map, Vector3f::UnitZ());
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].p_W.x(), (4 * 0.0010 + 0.0015) / 5, 1e-7);
  EXPECT_EQ(samples[0].measurements, 2);
  EXPECT_NEAR(samples[0].weight, 125.0f, 1e-2);  // 1/mm^2
}

TEST(MeasurementMap, OppositeSidesOfOneCellStayApart) {
  MeasurementMap map(0.002f);
  map.Insert({{0.001f, 0.001f, 0.0015f}, Vector3f::UnitZ(), 0.0001f});
  map.Insert({{0.001f, 0.001f, 0.0005f}, -Vector3f::UnitZ(), 0.0001f});
  const auto above = GatherAll(map, Vector3f::UnitZ());
  ASSERT_EQ(above.size(), 1u);
  EXPECT_FLOAT_EQ(above[0].p_W.z(), 0.0015f);
  EXPECT_FLOAT_EQ(GatherAll(map, -Vector3f::UnitZ())[0].p_W.z(), 0.0005f);
}

TEST(MeasurementMap, SamplesBeyondTheRadiusAreLeftOut) {
  MeasurementMap map(0.002f);
  map.Insert({{0.0f, 0.0f, 0.0051f}, Vector3f::UnitZ(), 0.0001f});
  map.Insert({{0.0f, 0.0f, 0.0049f}, Vector3f::UnitX(), 0.0001f});
  std::vector<Sample> samples;
  map.Gather(Vector3f::Zero(), 0.005f, Vector3f(1, 0, 1).normalized(), 0.1f, samples);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_FLOAT_EQ(samples[0].p_W.z(), 0.0049f);
}

}  // namespace
}  // namespace nbs
