#include "services/mesher/loop_filling.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Eigen::Vector3f;

bool Always(uint32_t, uint32_t) { return true; }

std::vector<SurfaceCorner> MakeFlat(const std::vector<Vector3f>& points) {
  std::vector<SurfaceCorner> corners;
  for (const Vector3f& p : points) corners.push_back({p, Vector3f::UnitZ()});
  return corners;
}

float CalcArea(const std::vector<SurfaceCorner>& corners, const std::vector<std::array<uint32_t, 3>>& triangles) {
  float area = 0.0f;
  for (const auto& t : triangles)
    area += 0.5f * (corners[t[1]].p_W - corners[t[0]].p_W).cross(corners[t[2]].p_W - corners[t[0]].p_W).z();
  return area;
}

TEST(LoopFilling, QuadIsCutAlongItsShorterDiagonal) {
  const auto corners = MakeFlat({{0, 0, 0}, {3, -1, 0}, {6, 0, 0}, {3, 1, 0}});
  const auto triangles = TriangulateLoop(corners, Always);
  ASSERT_EQ(triangles.size(), 2u);
  for (const auto& t : triangles)
    EXPECT_TRUE(std::count(t.begin(), t.end(), 1u) == 1 && std::count(t.begin(), t.end(), 3u) == 1);
}

TEST(LoopFilling, ForbiddenDiagonalIsNotUsed) {
  const auto corners = MakeFlat({{0, 0, 0}, {3, -1, 0}, {6, 0, 0}, {3, 1, 0}});
  const auto triangles = TriangulateLoop(corners, [](uint32_t i, uint32_t j) { return !(i == 1 && j == 3); });
  ASSERT_EQ(triangles.size(), 2u);
  for (const auto& t : triangles)
    EXPECT_TRUE(std::count(t.begin(), t.end(), 0u) == 1 && std::count(t.begin(), t.end(), 2u) == 1);
}

TEST(LoopFilling, LoopThatRunsTheOtherWayHasNoFilling) {
  EXPECT_TRUE(TriangulateLoop(MakeFlat({{3, 1, 0}, {6, 0, 0}, {3, -1, 0}, {0, 0, 0}}), Always).empty());
}

TEST(LoopFilling, LoopWithoutAllowedDiagonalsStaysOpen) {
  EXPECT_TRUE(TriangulateLoop(MakeFlat({{0, 0, 0}, {3, -1, 0}, {6, 0, 0}, {3, 1, 0}}), [](uint32_t, uint32_t) {
                return false;
              }).empty());
}

TEST(LoopFilling, StarShapedLoopsAreCoveredOnceAndWholly) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const int n = 4 + static_cast<int>(seed % 12);
    std::vector<Vector3f> points;
    float expected = 0.0f;
    for (int i = 0; i < n; ++i) {
      const float a = 2.0f * static_cast<float>(M_PI) * static_cast<float>(i) / static_cast<float>(n);
      const float r = static_cast<float>(1.0 + 2.0 * CalcUniform({41, seed, static_cast<uint64_t>(i)}));
      points.emplace_back(r * std::cos(a), r * std::sin(a), 0.0f);
    }
    for (int i = 0; i < n; ++i) expected += 0.5f * points[i].cross(points[(i + 1) % n]).z();
    const auto corners = MakeFlat(points);
    const auto triangles = TriangulateLoop(corners, Always);
    ASSERT_EQ(triangles.size(), static_cast<size_t>(n - 2)) << seed;
    EXPECT_NEAR(CalcArea(corners, triangles), expected, 1e-4f * expected);  // All counter-clockwise, none twice.
  }
}

/// A loop around the rim of a plate 3 mm thick, with parts of both of its faces.
std::vector<SurfaceCorner> MakeLoopAroundARim() {
  const std::vector<std::pair<Vector3f, Vector3f>> corners{
      {{-49.7f, 8.5f, 1.0f}, {-0.74f, 0.0f, 0.67f}},   {{-47.9f, 9.7f, 1.5f}, {-0.15f, 0.0f, 0.99f}},
      {{-48.0f, 13.7f, 1.5f}, {-0.14f, 0.0f, 0.99f}},  {{-49.7f, 12.4f, 1.1f}, {-0.73f, 0.0f, 0.69f}},
      {{-49.9f, 10.6f, -1.4f}, {-0.99f, 0.0f, 0.15f}}, {{-49.7f, 12.2f, -1.1f}, {-0.77f, 0.0f, -0.64f}},
      {{-47.9f, 10.3f, -1.4f}, {0.0f, 0.0f, -1.0f}},   {{-49.7f, 8.0f, -1.0f}, {-0.76f, 0.0f, -0.65f}}};
  std::vector<SurfaceCorner> loop;
  for (const auto& [p, n] : corners) loop.push_back({1e-3f * p, n.normalized()});
  return loop;
}

TEST(LoopFilling, LoopAroundARimIsFilledFacingItsNormals) {
  const auto corners = MakeLoopAroundARim();
  const auto triangles = TriangulateLoop(corners, Always);
  ASSERT_EQ(triangles.size(), 6u);
  for (const auto& t : triangles) EXPECT_TRUE(FacesItsNormals(corners[t[0]], corners[t[1]], corners[t[2]]));
}

TEST(LoopFilling, LoopAroundARimThatRunsTheOtherWayHasNoFilling) {
  auto corners = MakeLoopAroundARim();
  std::reverse(corners.begin(), corners.end());
  EXPECT_TRUE(TriangulateLoop(corners, Always).empty());
}

TEST(LoopFilling, SliverIsNoTriangle) {
  const auto corners = MakeFlat({{0, 0, 0}, {3, 0.01f, 0}, {6, 0, 0}});
  EXPECT_FALSE(FacesItsNormals(corners[0], corners[2], corners[1]));
}

TEST(LoopFilling, TriangleOverARidgeFacesItsNormals) {
  const SurfaceCorner top{{-1, 0, 0}, Vector3f::UnitZ()}, side{{0, 0, -1}, Vector3f::UnitX()},
      other{{-1, 2, 0}, Vector3f::UnitZ()};
  EXPECT_TRUE(FacesItsNormals(top, side, other));
  EXPECT_FALSE(FacesItsNormals(top, other, side));
}

}  // namespace
}  // namespace nbs
