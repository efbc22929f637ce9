#include "services/planner/hole_detection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/services/planner/synthetic_mesh.h"

namespace nbs {
namespace {

using ::testing::ElementsAre;

const Profiler kProfiler;

bool InBlock(int column, int row, int c0, int r0, int columns, int rows) {
  return column >= c0 && column < c0 + columns && row >= r0 && row < r0 + rows;
}

/// 240 x 240 mm with a hole of 30 x 12 mm about (75, 66), and one of 9 x 9 mm about (184.5, 184.5).
MeshReplica MakePlaneWithTwoHoles() {
  return MakePlaneMesh(81, 81,
                       [](int c, int r) { return !InBlock(c, r, 20, 20, 10, 4) && !InBlock(c, r, 60, 60, 3, 3); });
}

HoleDetectionSettings WithLimits(int min_edges, int max_edges) {
  HoleDetectionSettings settings;
  settings.min_edges = min_edges;
  settings.max_edges = max_edges;
  return settings;
}

HoleDetectionSettings OnlyHoles() {
  HoleDetectionSettings settings;
  settings.min_rim_m = 100.0;
  return settings;
}

TEST(HoleDetection, LoopsWithinTheLimitsAreHolesTheLargestFirst) {
  const MeshReplica mesh = MakePlaneWithTwoHoles();
  const BoundarySurface surface(mesh);
  const auto holes = FindHoles(surface);
  ASSERT_EQ(holes.size(), 2u);  // the outer rim has 320 edges
  EXPECT_EQ(holes[0].edges, 28u);
  EXPECT_EQ(holes[1].edges, 12u);
  EXPECT_NEAR(holes[0].area_m2, 30e-3 * 12e-3, 1e-8);
  EXPECT_NEAR((holes[0].centre_W - Eigen::Vector3d(0.075, 0.066, 0.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR(holes[0].normal_W.dot(Eigen::Vector3d::UnitZ()), 1.0, 1e-9);
}

TEST(HoleDetection, PinHoleIsNoHole) {
  const MeshReplica mesh = MakePlaneMesh(20, 20, [](int c, int r) { return c != 7 || r != 8; });
  EXPECT_TRUE(FindHoles(BoundarySurface(mesh), WithLimits(5, 60)).empty());
}

TEST(HoleDetection, OpenChainIsNoHole) {
  MeshReplica mesh;  // the second triangle is turned over, so that the border does not close
  mesh.Apply({.vertices = {{.id = 0, .p_W = {0, 0, 0}},
                           {.id = 1, .p_W = {1, 0, 0}},
                           {.id = 2, .p_W = {1, 1, 0}},
                           {.id = 3, .p_W = {0, 1, 0}}},
              .triangles = {{0, {0, 1, 2}}, {1, {0, 3, 2}}}});
  EXPECT_TRUE(FindHoles(BoundarySurface(mesh), WithLimits(1, 250)).empty());
}

TEST(HoleDetection, RimAroundAStandingSurfaceTakesItsPlane) {
  // A tube seen from outside: the border normals point to the side, their mean says nothing; the openings look up and
  // down.
  const MeshReplica mesh = MakeGridMesh(
      64, 11, [](int c, int r) { return CalcCylinderPoint(0.05, 2.0 * std::numbers::pi * c / 64.0, 0.003 * r); });
  MeshDelta seam;
  for (uint32_t r = 0; r < 10; ++r) {
    const uint32_t slot = 2 * 63 * 10 + 2 * r;
    const uint32_t v = 64 * r;
    seam.triangles.push_back({slot, {v + 63, v, v + 64}});
    seam.triangles.push_back({slot + 1, {v + 63, v + 64, v + 127}});
  }
  MeshReplica tube = mesh;
  tube.Apply(seam);
  const BoundarySurface surface(tube);
  ASSERT_EQ(surface.lines().size(), 2u);
  EXPECT_NEAR(MakeHole(surface, 0).normal_W.z(), -1.0, 1e-3);
  EXPECT_NEAR(MakeHole(surface, 1).normal_W.z(), 1.0, 1e-3);
}

TEST(HoleDetection, StripLiesAlongTheLargestExtentWithOverhang) {
  const MeshReplica mesh = MakePlaneWithTwoHoles();
  const BoundarySurface surface(mesh);
  const Strip strip = MakeHoleStrip(surface, {FindHoles(surface)[0]}, 0.02);
  EXPECT_NEAR(std::abs(strip.along_W.x()), 1.0, 1e-6);
  EXPECT_NEAR(strip.extent_m, 0.03 + 0.04, 1e-6);
  EXPECT_NEAR((strip.p_W - Eigen::Vector3d(0.075, 0.066, 0.0)).norm(), 0.0, 1e-6);
}

TEST(HoleDetection, NearHolesWithOneOrientationGiveACombinedStripOverBoth) {
  const MeshReplica mesh =
      MakePlaneMesh(81, 81, [](int c, int r) { return !InBlock(c, r, 20, 20, 4, 4) && !InBlock(c, r, 20, 50, 4, 4); });
  const BoundarySurface surface(mesh);
  const auto holes = FindHoles(surface);
  const auto groups = FindSimilarHoles(holes);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_THAT(groups[0], ElementsAre(0, 1));
  const Strip strip = MakeHoleStrip(surface, holes, 0.0);
  EXPECT_NEAR(std::abs(strip.along_W.y()), 1.0, 1e-6);
  EXPECT_NEAR(strip.extent_m, 34 * 0.003, 1e-6);
}

TEST(HoleDetection, FarOrDifferentlyOrientedHolesAreNotCombined) {
  Hole a{.centre_W = {0, 0, 0}, .normal_W = {0, 0, 1}};
  Hole far{.centre_W = {0.3, 0, 0}, .normal_W = {0, 0, 1}};
  Hole turned{.centre_W = {0.01, 0, 0}, .normal_W = {1, 0, 0}};
  EXPECT_TRUE(FindSimilarHoles({a, far, turned}).empty());
}

TEST(HoleDetection, OneLookGoesStraightAlongTheNormalAtTheStandoff) {
  const MeshReplica mesh = MakePlaneWithTwoHoles();
  bool found = false;
  for (const Candidate& c : FindHoleCandidates(BoundarySurface(mesh), 3, kProfiler, OnlyHoles())) {
    EXPECT_EQ(c.source, CandidateSource::kHole);
    EXPECT_EQ(c.born_scan, 3);
    const Eigen::Vector3d middle = 0.5 * (c.path.X_WS_start.translation() + c.path.X_WS_end.translation());
    found |= (middle - Eigen::Vector3d(0.075, 0.066, kProfiler.standoff_m)).norm() < 1e-6 &&
             c.path.X_WS_start.linear().col(2).z() < -1.0 + 1e-9;
  }
  EXPECT_TRUE(found);
}

TEST(HoleDetection, SomeLooksAreTilted) {
  const MeshReplica mesh = MakePlaneWithTwoHoles();
  double most = 0.0;
  for (const Candidate& c : FindHoleCandidates(BoundarySurface(mesh), 3, kProfiler, OnlyHoles())) {
    most = std::max(most, std::acos(std::clamp(-c.path.X_WS_start.linear().col(2).z(), -1.0, 1.0)));
  }
  EXPECT_GT(most, 0.9);
}

TEST(HoleDetection, RimsThatAreLeftGivePathsBesideThem) {
  const MeshReplica mesh = MakePlaneMesh(101, 101);  // no hole, a rim of 400 edges
  const auto candidates = FindHoleCandidates(BoundarySurface(mesh), 3, kProfiler);
  EXPECT_TRUE(FindHoles(BoundarySurface(mesh)).empty());
  EXPECT_GT(candidates.size(), 10u);
  EXPECT_TRUE(FindHoleCandidates(BoundarySurface(mesh), 3, kProfiler, OnlyHoles()).empty());
}

TEST(HoleDetection, ClosedSurfaceGivesNothing) {
  EXPECT_TRUE(FindHoleCandidates(BoundarySurface(MeshReplica()), 0, kProfiler).empty());
}

TEST(HoleDetection, CandidatesAreRankedAndNotAlike) {
  const HoleDetectionSettings settings;
  const MeshReplica mesh = MakePlaneWithTwoHoles();
  const auto candidates = FindHoleCandidates(BoundarySurface(mesh), 3, kProfiler, settings);
  for (size_t i = 0; i < candidates.size(); ++i) {
    EXPECT_EQ(candidates[i].rank, static_cast<int>(i));
    for (size_t j = 0; j < i; ++j)
      EXPECT_FALSE(AreAlike(candidates[i].path, candidates[j].path, settings.alike_m, settings.alike_rad));
  }
}

}  // namespace
}  // namespace nbs
