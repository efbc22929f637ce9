#include "common/geometry/borders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace nbs {
namespace {

using ::testing::ElementsAre;
using Triangle = std::array<uint32_t, 3>;

struct Soup {
  std::vector<Eigen::Vector3f> positions_W;
  std::vector<Triangle> triangles;

  std::vector<BorderEdge> Edges() const { return FindBorderEdges(triangles); }
  std::vector<BorderLine> Lines() const { return FindBorderLines(Edges(), triangles, positions_W); }
};

/// A flat grid of size x size squares of 1 mm in the xy-plane, seen from +z.
Soup MakeGrid(uint32_t size) {
  Soup soup;
  for (uint32_t y = 0; y <= size; ++y) {
    for (uint32_t x = 0; x <= size; ++x) soup.positions_W.emplace_back(0.001f * x, 0.001f * y, 0.0f);
  }
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const uint32_t v = y * (size + 1) + x;
      soup.triangles.push_back({v, v + 1, v + size + 2});
      soup.triangles.push_back({v, v + size + 2, v + size + 1});
    }
  }
  return soup;
}

/// Takes the two triangles of square (x, y) out of a grid.
void Cut(Soup& grid, uint32_t size, uint32_t x, uint32_t y) {
  grid.triangles[2 * (y * size + x)] = {0, 0, 0};
  grid.triangles[2 * (y * size + x) + 1] = {0, 0, 0};
}

std::set<std::pair<uint32_t, uint32_t>> FindBorderEdgesByBruteForce(const std::vector<Triangle>& triangles) {
  std::map<std::pair<uint32_t, uint32_t>, int> uses;
  for (const Triangle& t : triangles) {
    if (t[0] == t[1]) continue;
    for (int c = 0; c < 3; ++c) ++uses[std::minmax({t[c], t[(c + 1) % 3]})];
  }
  std::set<std::pair<uint32_t, uint32_t>> border;
  for (const auto& [edge, count] : uses) {
    if (count == 1) border.insert(edge);
  }
  return border;
}

TEST(Borders, ClosedSurfaceHasNone) {
  const std::vector<Triangle> tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_TRUE(FindBorderEdges(tetrahedron).empty());
}

TEST(Borders, TriangleIsOneLoopInItsOwnDirection) {
  const Soup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 0, 1}}};
  const auto lines = soup.Lines();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].closed);
  EXPECT_THAT(lines[0].vertices, ElementsAre(0, 1, 2));
}

TEST(Borders, NothingInNothingOut) {
  EXPECT_TRUE(FindBorderEdges({}).empty());
  EXPECT_TRUE(FindBorderLines({}, {}, {}).empty());
}

TEST(Borders, EmptySlotsArePassedOver) {
  const std::vector<Triangle> triangles = {{0, 0, 0}, {0, 1, 2}, {7, 7, 7}};
  EXPECT_EQ(FindBorderEdges(triangles).size(), 3u);
}

TEST(Borders, EdgeWithThreeTrianglesIsNone) {
  const std::vector<Triangle> fin = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  for (const BorderEdge& e : FindBorderEdges(fin)) EXPECT_FALSE(std::minmax(e.from, e.to) == std::minmax(0u, 1u));
}

TEST(Borders, EdgesEqualThoseOfBruteForceOnRandomSubsets) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    Soup soup = MakeGrid(12);
    for (Triangle& t : soup.triangles) {
      if (random() % 3 == 0) t = {0, 0, 0};
    }
    std::set<std::pair<uint32_t, uint32_t>> found;
    for (const BorderEdge& e : soup.Edges()) found.insert(std::minmax(e.from, e.to));
    EXPECT_EQ(found, FindBorderEdgesByBruteForce(soup.triangles));
  }
}

TEST(Borders, EveryEdgeComesInExactlyOneClosedLineOnRandomSubsets) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 20; ++trial) {
    Soup soup = MakeGrid(12);
    for (Triangle& t : soup.triangles) {
      if (random() % 3 == 0) t = {0, 0, 0};
    }
    const auto edges = soup.Edges();
    std::vector<int> uses(edges.size(), 0);
    for (const BorderLine& line : soup.Lines()) {
      EXPECT_TRUE(line.closed);
      for (size_t i = 0; i < line.edges.size(); ++i) {
        ++uses[line.edges[i]];
        EXPECT_EQ(edges[line.edges[i]].from, line.vertices[i]);
        EXPECT_EQ(edges[line.edges[i]].to, line.vertices[(i + 1) % line.vertices.size()]);
      }
    }
    EXPECT_TRUE(std::all_of(uses.begin(), uses.end(), [](int n) { return n == 1; }));
  }
}

TEST(Borders, HoleAndRimAreTwoLoopsOrderedByLowestVertex) {
  Soup soup = MakeGrid(5);
  Cut(soup, 5, 2, 2);
  const auto lines = soup.Lines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].edges.size(), 20u);
  EXPECT_EQ(lines[0].vertices.front(), 0u);
  EXPECT_EQ(lines[1].edges.size(), 4u);
  EXPECT_EQ(lines[1].vertices.front(), 2u * 6 + 2);
}

TEST(Borders, TwoHolesThatTouchInAVertexAreTwoLoops) {
  Soup soup = MakeGrid(6);
  Cut(soup, 6, 2, 2);
  Cut(soup, 6, 3, 3);
  const auto lines = soup.Lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1].edges.size(), 4u);
  EXPECT_EQ(lines[2].edges.size(), 4u);
}

TEST(Borders, FourHolesAroundAVertexWithFourFansStaySeparate) {
  // A wheel of eight sectors around vertex 0, every second one missing.
  Soup soup;
  soup.positions_W.emplace_back(0.0f, 0.0f, 0.0f);
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.25 * std::numbers::pi * i;
    soup.positions_W.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                                  0.02f * (i % 3));
    soup.positions_W.emplace_back(static_cast<float>(2 * std::cos(angle)), static_cast<float>(2 * std::sin(angle)),
                                  0.0f);
  }
  for (uint32_t i = 0; i < 8; ++i) {
    const uint32_t a = 1 + 2 * i;
    const uint32_t b = 1 + 2 * ((i + 1) % 8);
    if (i % 2 == 0) soup.triangles.push_back({0, a, b});
    soup.triangles.push_back({a, a + 1, b + 1});
    soup.triangles.push_back({a, b + 1, b});
  }
  int holes = 0;
  for (const BorderLine& line : soup.Lines()) holes += line.edges.size() == 3 ? 1 : 0;
  EXPECT_EQ(holes, 4);
}

TEST(Borders, BrokenOrientationGivesOpenChains) {
  const Soup soup{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 3, 2}}};  // the second is turned over
  size_t edges = 0;
  for (const BorderLine& line : soup.Lines()) {
    EXPECT_FALSE(line.closed);
    EXPECT_EQ(line.vertices.size(), line.edges.size() + 1);
    edges += line.edges.size();
  }
  EXPECT_EQ(edges, 4u);
}

TEST(Borders, OrderOfTrianglesDoesNotChangeTheLines) {
  Soup soup = MakeGrid(8);
  Cut(soup, 8, 2, 2);
  Cut(soup, 8, 3, 3);
  Cut(soup, 8, 6, 1);
  const auto before = soup.Lines();
  std::mt19937 random(7);
  std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
  const auto after = soup.Lines();
  ASSERT_EQ(before.size(), after.size());
  for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].vertices, after[i].vertices);
}

TEST(Borders, MeasureOfASquareHole) {
  Soup soup = MakeGrid(5);
  Cut(soup, 5, 2, 2);
  const BorderMeasure measure = CalcBorderMeasure(soup.Lines()[1], soup.positions_W);
  EXPECT_NEAR(measure.length_m, 0.004, 1e-8);
  EXPECT_NEAR((measure.centroid_W - Eigen::Vector3d(0.0025, 0.0025, 0.0)).norm(), 0.0, 1e-8);
  EXPECT_NEAR((measure.area_vector_W - Eigen::Vector3d(0.0, 0.0, -1e-6)).norm(), 0.0,
              1e-12);  // clockwise seen from outside
}

TEST(Borders, AreaVectorDoesNotDependOnWhereTheLoopLies) {
  Soup soup = MakeGrid(5);
  const Eigen::Vector3d before = CalcBorderMeasure(soup.Lines()[0], soup.positions_W).area_vector_W;
  for (Eigen::Vector3f& p : soup.positions_W) p += Eigen::Vector3f(1.0f, -2.0f, 3.0f);
  const Eigen::Vector3d after = CalcBorderMeasure(soup.Lines()[0], soup.positions_W).area_vector_W;
  EXPECT_NEAR((before - Eigen::Vector3d(0.0, 0.0, 25e-6)).norm(), 0.0, 1e-10);
  EXPECT_NEAR((before - after).norm(), 0.0, 1e-8);
}

TEST(Borders, QuarterMillionTrianglesTakeAFractionOfASecond) {
  Soup soup = MakeGrid(354);
  for (size_t i = 0; i < soup.triangles.size(); i += 40) soup.triangles[i] = {0, 0, 0};
  const auto start = std::chrono::steady_clock::now();
  const auto lines = soup.Lines();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  RecordProperty("milliseconds", std::to_string(1e3 * spent.count()));
  EXPECT_GT(lines.size(), 5000u);
  EXPECT_LT(spent.count(), 0.5);  // about 25 ms on an idle core of 2020
}

}  // namespace
}  // namespace nbs
