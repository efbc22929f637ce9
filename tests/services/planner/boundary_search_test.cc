#include "services/planner/boundary_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/runtime/counter_random.h"
#include "tests/services/planner/synthetic_mesh.h"

namespace nbs {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Profiler kProfiler;

/// The scan that made the front (-y side) of something that stands on z = 0: moves up, looks along +y.
ScanPath MakeScanOfTheFront() {
  const auto pose = [](double z) {
    return MakeLookPose({0.0, -0.45, z}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
  };
  return {pose(0.0), pose(0.3)};
}

MeshReplica MakeFrontOfCylinder(double radius) {
  return MakeCylinderMesh(radius, -150.0 * kDegree, -30.0 * kDegree, 0.15);
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

Eigen::Vector3d CalcTarget(const ScanPath& path) {
  return 0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation()) +
         kProfiler.standoff_m * path.X_WS_start.linear().col(2);
}

/// The chain along the cylinder's edge at -30 degrees.
BoundaryChain FindRightSide(const BoundarySurface& surface) {
  for (const BoundaryChain& chain : FindBoundaryChains(surface, 0, MakeScanOfTheFront())) {
    if (chain.boundary_class <= BoundaryClass::kRight && surface.Position(chain.vertices[0]).x() > 0.0) return chain;
  }
  throw std::runtime_error("no chain");
}

TEST(BoundarySearch, SurfaceBeyondACylinderIsForetold) {
  for (double radius : {0.05, 0.08, 0.15}) {
    const MeshReplica mesh = MakeFrontOfCylinder(radius);
    const BoundarySurface surface(mesh);
    const auto patch = FitBoundaryPatch(surface, FindRightSide(surface));
    ASSERT_TRUE(patch);
    for (double distance : {0.03, 0.06, 0.09}) {
      const EstimatedSurface beyond = Extrapolate(*patch, distance);
      const SurfacePoint truth = CalcCylinderPoint(radius, -30.0 * kDegree + distance / radius, beyond.p_W.z());
      EXPECT_LT((beyond.p_W - truth.p_W).norm(), 0.15 * distance) << radius << " " << distance;
      const double bound =
          5.0 * kDegree + 0.15 * distance / radius;  // a parabola bends a little more than the arc under it
      EXPECT_LT(AngleBetween(beyond.normal_W, truth.normal_W), bound) << radius << " " << distance;
      EXPECT_NEAR(beyond.turned_rad, distance / radius, bound);
    }
  }
}

TEST(BoundarySearch, SurfaceBeyondANoisyCylinderIsForetoldWithinTwentyDegrees) {
  const double radius = 0.08;
  const MeshReplica mesh = MakeGridMesh(57, 51, [=](int c, int r) {
    SurfacePoint point = CalcCylinderPoint(radius, (-150.0 + 120.0 * c / 56) * kDegree, 0.003 * r);
    point.p_W += 0.0005 * CalcGaussian({1, static_cast<uint64_t>(c), static_cast<uint64_t>(r)}) * point.normal_W;
    return point;
  });
  const BoundarySurface surface(mesh);
  const auto patch = FitBoundaryPatch(surface, FindRightSide(surface));
  ASSERT_TRUE(patch);
  for (double distance : {0.03, 0.06, 0.09}) {
    const EstimatedSurface beyond = Extrapolate(*patch, distance);
    const SurfacePoint truth = CalcCylinderPoint(radius, -30.0 * kDegree + distance / radius, beyond.p_W.z());
    EXPECT_LT((beyond.p_W - truth.p_W).norm(), 0.25 * distance) << distance;
    EXPECT_LT(AngleBetween(beyond.normal_W, truth.normal_W), 20.0 * kDegree) << distance;
  }
}

TEST(BoundarySearch, SurfaceBeyondASphericalCapIsForetold) {
  const double radius = 0.12;
  const MeshReplica mesh = MakeGridMesh(81, 15, [=](int c, int r) {  // polar cap without its pole, seen from outside
    const double azimuth = 2.0 * std::numbers::pi * c / 80.0;
    const double polar = (40.0 - 25.0 * r / 14.0) * kDegree;
    const Eigen::Vector3d n(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    return SurfacePoint{radius * n, n};
  });
  const BoundarySurface surface(mesh);
  BoundaryChainSettings chains;
  chains.max_length_m = 0.08;
  int tested = 0;
  for (const BoundaryChain& chain : CutRim(surface, surface.lines()[0], chains)) {
    const Eigen::Vector3d middle = surface.Position(chain.vertices[chain.vertices.size() / 2]);
    if (std::hypot(middle.x(), middle.y()) < 0.07 || chain.length_m < 0.04 || std::abs(chain.outward_W.z()) < 0.5)
      continue;  // the outer rim only
    const auto patch = FitBoundaryPatch(surface, chain);
    ASSERT_TRUE(patch);
    const EstimatedSurface beyond = Extrapolate(*patch, 0.06);
    EXPECT_NEAR(beyond.p_W.norm(), radius, 0.012);
    EXPECT_LT(AngleBetween(beyond.normal_W, beyond.p_W), 12.0 * kDegree);
    ++tested;
  }
  EXPECT_GT(tested, 3);
}

TEST(BoundarySearch, ExtrapolationOfAPlaneIsStraight) {
  QuadraticPatch plane;
  plane.coefficients(3) = 0.5;
  const EstimatedSurface beyond = Extrapolate(plane, 0.1);
  EXPECT_NEAR(beyond.p_W.norm(), 0.1, 1e-12);
  EXPECT_NEAR(beyond.p_W.z(), 0.5 * beyond.p_W.x(), 1e-12);
  EXPECT_NEAR(beyond.turned_rad, 0.0, 1e-12);
}

TEST(BoundarySearch, CurvatureIsClamped) {
  QuadraticPatch sharp;
  sharp.coefficients(0) = -500.0;
  EXPECT_NEAR(Extrapolate(sharp, 0.02).turned_rad, 0.02 * BoundarySearchSettings().max_convex_per_m, 1e-9);
  sharp.coefficients(0) = 500.0;
  EXPECT_NEAR(Extrapolate(sharp, 0.02).turned_rad, -0.02 * BoundarySearchSettings().max_concave_per_m, 1e-9);
}

TEST(BoundarySearch, FirstPathLooksStraightAtTheEstimatedSurfaceParallelToTheBorder) {
  const double radius = 0.08;
  const MeshReplica mesh = MakeFrontOfCylinder(radius);
  const BoundarySurface surface(mesh);
  const auto paths = MakeChainPaths(surface, FindRightSide(surface), kProfiler);
  ASSERT_FALSE(paths.empty());
  const Eigen::Vector3d target = CalcTarget(paths[0]);
  const Eigen::Vector3d normal(target.x(), target.y(), 0.0);
  EXPECT_NEAR(normal.norm(), radius, 0.015);
  EXPECT_LT(AngleBetween(-paths[0].X_WS_start.linear().col(2), normal), 12.0 * kDegree);
  EXPECT_GT(std::abs(paths[0].X_WS_start.linear().col(1).z()), 0.99);
  EXPECT_NEAR(paths[0].length_m(), 0.15 + 2 * BoundarySearchSettings().overhang_m, 0.02);
}

TEST(BoundarySearch, PathsEndWhereTheSurfaceHasTurnedAway) {
  const MeshReplica mesh = MakeFrontOfCylinder(0.08);
  const BoundarySurface surface(mesh);
  BoundarySearchSettings settings;
  settings.tilts_rad = {0.0};
  const size_t all = MakeChainPaths(surface, FindRightSide(surface), kProfiler, settings).size();
  settings.max_turn_away_rad = 50.0 * kDegree;  // 70 mm on this cylinder
  const size_t near = MakeChainPaths(surface, FindRightSide(surface), kProfiler, settings).size();
  EXPECT_GT(near, 0u);
  EXPECT_LT(near, all);
}

TEST(BoundarySearch, OverlapKeepsTheOutermostStripeOnOldData) {
  const MeshReplica mesh = MakePlaneMesh(41, 41);
  const BoundarySurface surface(mesh);
  BoundarySearchSettings settings;
  settings.tilts_rad = {0.0};
  settings.overlap_m = 0.05;
  for (const BorderLine& line : surface.lines()) {
    for (const BoundaryChain& chain : CutRim(surface, line)) {
      for (const ScanPath& path : MakeChainPaths(surface, chain, kProfiler, settings)) {
        const double beyond = chain.outward_W.dot(CalcTarget(path) - surface.Position(chain.vertices[0]));
        EXPECT_LE(beyond, CalcHalfWidth(kProfiler) - settings.overlap_m + 0.005);
        EXPECT_GT(beyond, 0.02);
      }
    }
  }
}

TEST(BoundarySearch, PositiveTiltLooksBackFromBeyondTheBorder) {
  const MeshReplica mesh = MakePlaneMesh(41, 41);
  const BoundarySurface surface(mesh);
  BoundarySearchSettings settings;
  settings.tilts_rad = {0.5};
  for (const BoundaryChain& chain : CutRim(surface, surface.lines()[0])) {
    for (const ScanPath& path : MakeChainPaths(surface, chain, kProfiler, settings))
      EXPECT_LT(path.X_WS_start.linear().col(2).dot(chain.outward_W), -0.3);
  }
}

TEST(BoundarySearch, LongerChainsGetPathsOverTheWholeObject) {
  const MeshReplica mesh = MakeFrontOfCylinder(0.08);
  BoundarySurface surface(mesh);
  BoundarySearchSettings settings;
  settings.chains.max_length_m = 0.08;
  double longest = 0.0;
  for (const Candidate& c : FindBoundaryCandidates(surface, 0, MakeScanOfTheFront(), kProfiler, settings)) {
    longest = std::max(longest, c.path.length_m());
  }
  EXPECT_GE(longest, 0.15 + 2 * settings.overhang_m - 1e-9);
}

TEST(BoundarySearch, CandidatesAreRankedRigidWithinLimitsAndNotAlike) {
  const MeshReplica mesh = MakeFrontOfCylinder(0.08);
  const BoundarySearchSettings settings;
  const auto candidates = FindBoundaryCandidates(BoundarySurface(mesh), 7, MakeScanOfTheFront(), kProfiler, settings);
  EXPECT_TRUE(candidates.empty());  // no vertex of scan 7
  const auto of_scan_0 = FindBoundaryCandidates(BoundarySurface(mesh), 0, MakeScanOfTheFront(), kProfiler, settings);
  ASSERT_GT(of_scan_0.size(), 20u);
  for (size_t i = 0; i < of_scan_0.size(); ++i) {
    EXPECT_EQ(of_scan_0[i].rank, static_cast<int>(i));
    EXPECT_EQ(of_scan_0[i].source, CandidateSource::kBoundary);
    EXPECT_EQ(of_scan_0[i].born_scan, 0);
    EXPECT_TRUE(IsRigid(of_scan_0[i].path.X_WS_start));
    EXPECT_GE(of_scan_0[i].path.length_m(), settings.limits.min_m - 1e-9);
    EXPECT_LE(of_scan_0[i].path.length_m(), settings.limits.max_m + 1e-9);
    for (size_t j = 0; j < i; ++j)
      EXPECT_FALSE(AreAlike(of_scan_0[i].path, of_scan_0[j].path, settings.alike_m, settings.alike_rad));
  }
}

TEST(BoundarySearch, TwoCallsGiveTheSameBits) {
  const MeshReplica mesh = MakeFrontOfCylinder(0.08);
  const auto a = FindBoundaryCandidates(BoundarySurface(mesh), 0, MakeScanOfTheFront(), kProfiler);
  const auto b = FindBoundaryCandidates(BoundarySurface(mesh), 0, MakeScanOfTheFront(), kProfiler);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i].path.X_WS_start.matrix() == b[i].path.X_WS_start.matrix());
}

}  // namespace
}  // namespace nbs
