#include "sim/scene.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/runtime/counter_random.h"
#include "sim/closest_on_triangle.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

Vector3d MakeRandomVector(uint64_t seed, uint64_t i) {
  return {2.0 * CalcUniform({seed, i, 0}) - 1.0, 2.0 * CalcUniform({seed, i, 1}) - 1.0,
          2.0 * CalcUniform({seed, i, 2}) - 1.0};
}

/// A cloud of random triangles, about 0.4 wide, in the cube from -1 to 1.
TriangleMesh MakeSoup(int triangles) {
  TriangleMesh mesh;
  for (int t = 0; t < triangles; ++t) {
    const Vector3d center = MakeRandomVector(1, t);
    for (int i = 0; i < 3; ++i)
      mesh.vertices_W.push_back((center + 0.3 * MakeRandomVector(2, 3 * t + i)).cast<float>());
    const auto v = static_cast<uint32_t>(3 * t);
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

/// Distance along a ray by solving for the barycentric coordinates; infinity without a hit.
double CalcHitByAlgebra(const TriangleMesh& mesh, size_t t, const Ray& ray) {
  const Vector3d a = mesh.vertices_W[mesh.triangles[t][0]].cast<double>();
  Eigen::Matrix3d A;
  A.col(0) = mesh.vertices_W[mesh.triangles[t][1]].cast<double>() - a;
  A.col(1) = mesh.vertices_W[mesh.triangles[t][2]].cast<double>() - a;
  A.col(2) = -ray.direction_W;
  const Vector3d x = A.fullPivLu().solve(ray.p_W - a);
  const bool hit = x[0] >= 0.0 && x[1] >= 0.0 && x[0] + x[1] <= 1.0 && x[2] >= 0.0;
  return hit ? x[2] : std::numeric_limits<double>::infinity();
}

TEST(TriangleScene, FirstHitAgreesWithEveryTriangleTriedByAlgebra) {
  const TriangleMesh mesh = MakeSoup(200);
  const TriangleScene scene(mesh);
  std::vector<Ray> rays;
  for (int i = 0; i < 1003; ++i) rays.push_back({MakeRandomVector(3, i), MakeRandomVector(4, i).normalized()});
  const std::vector<RayHit> hits = scene.CastRays(rays, 10.0);
  int met = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) nearest = std::min(nearest, CalcHitByAlgebra(mesh, t, rays[i]));
    ASSERT_EQ(hits[i].hit(), std::isfinite(nearest)) << i;
    if (!hits[i].hit()) continue;
    ++met;
    EXPECT_NEAR(hits[i].distance_m, nearest, 1e-5) << i;
  }
  EXPECT_GT(met, 300);
}

TEST(TriangleScene, NormalPointsOutOfTheCounterClockwiseSide) {
  const TriangleScene scene(MakeSquare(1.0f, 0.5f));
  const RayHit above = scene.CastRay({{0.1, 0.2, 2.0}, -Vector3d::UnitZ()}, 10.0);
  const RayHit below = scene.CastRay({{0.1, 0.2, 0.0}, Vector3d::UnitZ()}, 10.0);
  EXPECT_EQ(above.normal_W, Vector3d::UnitZ());
  EXPECT_EQ(below.normal_W, Vector3d::UnitZ());
  EXPECT_NEAR(above.distance_m, 1.5, 1e-6);
  EXPECT_NEAR(below.distance_m, 0.5, 1e-6);
}

TEST(TriangleScene, NothingIsMetBeyondTheReach) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  EXPECT_FALSE(scene.CastRay({{0.1, 0.2, 2.0}, -Vector3d::UnitZ()}, 1.99).hit());
  EXPECT_TRUE(scene.CastRay({{0.1, 0.2, 2.0}, -Vector3d::UnitZ()}, 2.01).hit());
}

TEST(TriangleScene, RaysDoNotSlipThroughSharedEdges) {
  const TriangleScene scene(MakeSphere(1.0f, 3));
  for (int i = 0; i < 20000; ++i)
    EXPECT_TRUE(scene.CastRay({Vector3d::Zero(), MakeRandomVector(5, i).normalized()}, 2.0).hit());
  EXPECT_TRUE(scene.CastRay({Vector3d::Zero(), Vector3d::UnitX()}, 2.0).hit());
}

TEST(TriangleScene, SightIsBlockedOnlyBetweenItsEnds) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  const std::vector<TriangleScene::Segment> segments = {{{0.1, 0.2, 1.0}, {0.1, 0.2, -1.0}},
                                                        {{0.1, 0.2, 1.0}, {0.1, 0.2, 0.1}},
                                                        {{0.1, 0.2, 0.0}, {0.1, 0.2, 1.0}},
                                                        {{0.1, 0.2, 0.0}, {0.1, 0.2, 0.0}},
                                                        {{3.0, 0.2, 1.0}, {3.0, 0.2, -1.0}}};
  EXPECT_EQ(scene.FindBlocked(segments, 1e-4), (std::vector<uint8_t>{1, 0, 0, 0, 0}));
}

TEST(TriangleScene, ClosestPointAgreesWithEveryTriangleTried) {
  const TriangleMesh mesh = MakeSoup(300);
  const TriangleScene scene(mesh);
  for (int i = 0; i < 500; ++i) {
    const Vector3d p = MakeRandomVector(6, i);
    double nearest = 0.1;
    uint32_t id = RayHit::kNone;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const double distance =
          (CalcClosestOnTriangle(p, mesh.vertices_W[a].cast<double>(), mesh.vertices_W[b].cast<double>(),
                                 mesh.vertices_W[c].cast<double>()) -
           p)
              .norm();
      if (distance < nearest) {
        nearest = distance;
        id = t;
      }
    }
    const auto closest = scene.FindClosest(p, 0.1);
    ASSERT_EQ(closest.has_value(), id != RayHit::kNone) << i;
    if (!closest) continue;
    EXPECT_EQ(closest->triangle, id);
    EXPECT_DOUBLE_EQ(closest->distance_m, nearest);
  }
}

TEST(TriangleScene, ClosestFacingPassesOverTheNearerSideThatLooksAway) {
  TriangleMesh mesh = MakeSquare(1.0f, 0.0f);
  TriangleMesh back = MakeSquare(1.0f, -0.01f);
  for (const auto& p : back.vertices_W) mesh.vertices_W.push_back(p);
  for (const auto& [a, b, c] : back.triangles) mesh.triangles.push_back({c + 4, b + 4, a + 4});
  const TriangleScene scene(mesh);
  const Vector3d p(0.2, 0.1, 0.002);
  EXPECT_NEAR(scene.FindClosestFacing(p, 0.1, Vector3d::UnitZ(), 0.9)->distance_m, 0.002, 1e-9);
  EXPECT_NEAR(scene.FindClosestFacing(p, 0.1, -Vector3d::UnitZ(), 0.9)->distance_m, 0.012, 1e-9);
  EXPECT_FALSE(scene.FindClosestFacing(p, 0.1, Vector3d::UnitX(), 0.9).has_value());
}

TEST(TriangleScene, ClosestOnASharedEdgeIsTheLowerTriangle) {
  const TriangleScene scene(MakeSquare(1.0f, 0.0f));
  EXPECT_EQ(scene.FindClosest({0.25, 0.25, 0.5}, 1.0)->triangle, 0u);
}

TEST(TriangleScene, EmptyMeshIsNeverMet) {
  const TriangleScene scene{TriangleMesh{}};
  EXPECT_FALSE(scene.CastRay({Vector3d::Zero(), Vector3d::UnitX()}, 10.0).hit());
  EXPECT_FALSE(scene.FindClosest(Vector3d::Zero(), 10.0).has_value());
}

TEST(TriangleScene, RefusesATriangleWithoutVertex) {
  TriangleMesh mesh = MakeSquare(1.0f, 0.0f);
  mesh.triangles.push_back({0, 1, 4});
  EXPECT_THROW(TriangleScene{mesh}, std::invalid_argument);
}

TEST(ClosestOnTriangle, IsNoFartherThanAnyPointOfTheTriangle) {
  for (int i = 0; i < 200; ++i) {
    const Vector3d a = MakeRandomVector(7, 4 * i), b = MakeRandomVector(7, 4 * i + 1),
                   c = MakeRandomVector(7, 4 * i + 2);
    const Vector3d p = 2.0 * MakeRandomVector(7, 4 * i + 3);
    const double distance = (CalcClosestOnTriangle(p, a, b, c) - p).norm();
    double sampled = std::numeric_limits<double>::infinity();
    for (int u = 0; u <= 100; ++u) {
      for (int v = 0; u + v <= 100; ++v)
        sampled = std::min(sampled, (a + (b - a) * u / 100.0 + (c - a) * v / 100.0 - p).norm());
    }
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_GE(distance, sampled - 0.03);
  }
}

}  // namespace
}  // namespace nbs
