#include "services/planner/boundary_chains.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "tests/services/planner/synthetic_mesh.h"

namespace nbs {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

/// Looks down at the plane mesh and moves along +y: sensor x points to -x of the world (x = y cross z).
ScanPath MakeScanFromAbove() {
  const auto pose = [](double y) {
    return MakeLookPose({0.03, y, 0.3}, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  };
  return {pose(0.0), pose(0.12)};
}

std::vector<BoundaryClass> ListClasses(const std::vector<BoundaryChain>& chains) {
  std::vector<BoundaryClass> classes;
  for (const BoundaryChain& chain : chains) classes.push_back(chain.boundary_class);
  return classes;
}

TEST(BoundaryChains, RectangleGivesItsFourSidesInOrderOfClass) {
  const MeshReplica mesh = MakePlaneMesh(21, 41);  // 60 x 120 mm
  const BoundarySurface surface(mesh);
  const auto chains = FindBoundaryChains(surface, 0, MakeScanFromAbove());
  ASSERT_THAT(ListClasses(chains),
              ElementsAre(BoundaryClass::kLeft, BoundaryClass::kRight, BoundaryClass::kTop, BoundaryClass::kBottom));
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  EXPECT_GT(chains[0].outward_W.dot(x), 0.95);  // the sensor's left is the world's +x here
  EXPECT_GT(chains[1].outward_W.dot(-x), 0.95);
  EXPECT_GT(chains[2].outward_W.dot(y), 0.95);
  EXPECT_GT(chains[3].outward_W.dot(-y), 0.95);
  EXPECT_NEAR(chains[0].length_m, 0.12, 0.012);
  EXPECT_NEAR(chains[2].length_m, 0.06, 0.012);
}

TEST(BoundaryChains, ClosedSurfaceHasNone) {
  MeshReplica mesh;
  mesh.Apply({.vertices = {{.id = 0, .p_W = {0, 0, 0}},
                           {.id = 1, .p_W = {0.1f, 0, 0}},
                           {.id = 2, .p_W = {0, 0.1f, 0}},
                           {.id = 3, .p_W = {0, 0, 0.1f}}},
              .triangles = {{0, {0, 2, 1}}, {1, {0, 1, 3}}, {2, {1, 2, 3}}, {3, {2, 0, 3}}}});
  EXPECT_TRUE(FindBoundaryChains(BoundarySurface(mesh), 0, MakeScanFromAbove()).empty());
  EXPECT_TRUE(FindBoundaryChains(BoundarySurface(MeshReplica()), 0, MakeScanFromAbove()).empty());
}

TEST(BoundaryChains, BorderOfOlderScansIsLeftOut) {
  const MeshReplica mesh = MakePlaneMesh(
      21, 41, [](int, int) { return true; }, [](int column, int) { return column > 15 ? 1 : 0; });
  const auto chains = FindBoundaryChains(BoundarySurface(mesh), 1, MakeScanFromAbove());
  for (const BoundaryChain& chain : chains)
    EXPECT_NE(chain.boundary_class, BoundaryClass::kRight);  // the world's -x side, of scan 0
  ASSERT_FALSE(chains.empty());
  EXPECT_EQ(chains[0].boundary_class, BoundaryClass::kLeft);
  EXPECT_TRUE(FindBoundaryChains(BoundarySurface(mesh), 2, MakeScanFromAbove()).empty());
}

TEST(BoundaryChains, SingleOldVertexInNewBorderDoesNotCutIt) {
  const MeshReplica mesh = MakePlaneMesh(
      21, 41, [](int, int) { return true; }, [](int column, int row) { return column == 20 && row == 20 ? 0 : 1; });
  const auto chains = FindBoundaryChains(BoundarySurface(mesh), 1, MakeScanFromAbove());
  ASSERT_EQ(chains.size(), 4u);
  EXPECT_NEAR(chains[0].length_m, 0.12, 0.012);
}

TEST(BoundaryChains, PinHolesAreNoBoundaries) {
  const MeshReplica mesh = MakePlaneMesh(21, 41, [](int column, int row) { return column != 10 || row != 20; });
  EXPECT_EQ(FindBoundaryChains(BoundarySurface(mesh), 0, MakeScanFromAbove()).size(), 4u);
}

TEST(BoundaryChains, JaggedSideStaysOneChain) {
  const MeshReplica mesh = MakePlaneMesh(22, 41, [](int column, int row) { return column < 20 || row % 2 == 0; });
  const auto chains = FindBoundaryChains(BoundarySurface(mesh), 0, MakeScanFromAbove());
  EXPECT_THAT(ListClasses(chains),
              ElementsAre(BoundaryClass::kLeft, BoundaryClass::kRight, BoundaryClass::kTop, BoundaryClass::kBottom));
}

TEST(BoundaryChains, LongSideIsCutInEqualPieces) {
  const MeshReplica mesh = MakePlaneMesh(21, 151);  // 450 mm
  BoundaryChainSettings settings;
  settings.max_length_m = 0.16;
  int left = 0;
  for (const BoundaryChain& chain : FindBoundaryChains(BoundarySurface(mesh), 0, MakeScanFromAbove(), settings)) {
    EXPECT_LE(chain.length_m, settings.max_length_m + 0.004);
    if (chain.boundary_class != BoundaryClass::kLeft) continue;
    ++left;
    EXPECT_NEAR(chain.length_m, 0.15, 0.006);
  }
  EXPECT_EQ(left, 3);
}

TEST(BoundaryChains, ChainsOfOneClassAreOrderedByPositionInTheView) {
  const MeshReplica mesh = MakePlaneMesh(21, 151);
  BoundaryChainSettings settings;
  settings.max_length_m = 0.16;
  const BoundarySurface surface(mesh);
  double last = -1.0;
  for (const BoundaryChain& chain : FindBoundaryChains(surface, 0, MakeScanFromAbove(), settings)) {
    if (chain.boundary_class != BoundaryClass::kLeft) break;
    const double y = surface.Position(chain.vertices[chain.vertices.size() / 2]).y();  // the scan direction
    EXPECT_GT(y, last);
    last = y;
  }
}

TEST(BoundaryChains, RoundRimIsCutWhereItTurns) {
  const MeshReplica mesh = MakeGridMesh(60, 10, [](int c, int r) {  // a flat ring, seen from +z
    const double angle = -2.0 * std::numbers::pi * c / 59.0;
    const double radius = 0.03 + 0.003 * r;
    return SurfacePoint{{radius * std::cos(angle), radius * std::sin(angle), 0.0}, Eigen::Vector3d::UnitZ()};
  });
  const BoundarySurface surface(mesh);
  for (const BorderLine& line : surface.lines()) {
    for (const BoundaryChain& chain : CutRim(surface, line)) {
      const Eigen::Vector3d chord = surface.Position(chain.vertices.back()) - surface.Position(chain.vertices[0]);
      EXPECT_GT(chord.norm(), 0.6 * chain.length_m);
    }
  }
}

TEST(BoundaryChains, EveryEdgeOfARimComesInOnePiece) {
  const MeshReplica mesh = MakePlaneMesh(21, 41);
  const BoundarySurface surface(mesh);
  BoundaryChainSettings settings;
  settings.min_length_m = 0.0;
  size_t edges = 0;
  for (const BoundaryChain& chain : CutRim(surface, surface.lines()[0], settings)) edges += chain.vertices.size() - 1;
  EXPECT_EQ(edges, surface.edges().size());
}

TEST(BoundaryChains, TurningMeshAndScanTogetherChangesNothing) {
  const Pose X = MakePose({0.4, -0.3, 0.2}, Eigen::Quaterniond(0.3, 0.8, -0.2, 0.4));
  const auto turned = MakeGridMesh(21, 41, [&](int c, int r) {
    return SurfacePoint{X * Eigen::Vector3d(0.003 * c, 0.003 * r, 0.0), X.linear() * Eigen::Vector3d::UnitZ()};
  });
  const ScanPath path = MakeScanFromAbove();
  const auto here = FindBoundaryChains(BoundarySurface(MakePlaneMesh(21, 41)), 0, path);
  const auto there = FindBoundaryChains(BoundarySurface(turned), 0, {X * path.X_WS_start, X * path.X_WS_end});
  ASSERT_EQ(here.size(), there.size());
  for (size_t i = 0; i < here.size(); ++i) EXPECT_EQ(here[i].vertices, there[i].vertices);
}

}  // namespace
}  // namespace nbs
