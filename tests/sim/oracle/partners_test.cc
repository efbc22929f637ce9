#include "sim/oracle/partners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;

TEST(Partners, AreNearAndFaceTheSameWay) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const std::vector<SurfaceSample> samples = {
      {{0, 0, 0}, up}, {{0.0019, 0, 0}, up}, {{-0.0021, 0, 0}, up}, {{0, 0, -0.001}, -up}};
  const Partners partners(samples, 0.002, 1.3);
  EXPECT_THAT(partners.of(0), ElementsAre(1));
  EXPECT_THAT(partners.of(1), ElementsAre(0));
  EXPECT_THAT(partners.of(2), IsEmpty());
  EXPECT_THAT(partners.of(3), IsEmpty());
}

TEST(Partners, AreThoseOfBruteForce) {
  const auto samples = MakeSurfaceSamples(MakeSphere(0.02f, 3), 1500);
  const double distance_m = 0.003, angle_rad = 0.1;
  const Partners partners(samples, distance_m, angle_rad);
  size_t found = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    std::vector<uint32_t> expected;
    for (size_t j = 0; j < samples.size(); ++j) {
      const bool near = (samples[i].p_W - samples[j].p_W).norm() <= distance_m;
      if (j != i && near && samples[i].normal_W.dot(samples[j].normal_W) >= std::cos(angle_rad)) expected.push_back(j);
    }
    EXPECT_THAT(partners.of(i), ElementsAreArray(expected)) << i;
    found += expected.size();
  }
  EXPECT_GT(found, samples.size());
}

TEST(Partners, WithoutADistanceAreNone) {
  const auto samples = MakeSurfaceSamples(MakeSphere(0.02f, 3), 100);
  EXPECT_THAT(Partners(samples, 0.0, 1.3).of(50), IsEmpty());
  EXPECT_THAT([&] { Partners(samples, -1.0, 1.3); }, ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace nbs
