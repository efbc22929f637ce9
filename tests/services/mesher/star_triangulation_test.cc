// Vertices move about at random; what is left must be what would have been made of them at once.

#include "services/mesher/star_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/runtime/counter_random.h"
#include "tests/services/mesher/mesh_invariants.h"

namespace nbs {
namespace {

using Eigen::Vector3f;
using Triangle = MeshTopology::Triangle;

/// Vertices about 3 mm apart on a hilly square of 60 mm, a share of them left out.
class Hills {
 public:
  Hills(uint64_t seed, double gaps) : seed_(seed) {
    for (int i = 0; i < kEdge * kEdge; ++i) {
      if (CalcUniform({seed_, count_++}) < gaps) continue;
      places_.push_back(i);
      const uint32_t id = vertices_.Insert({MakePlace(i), Vector3f::UnitZ(), 1e-4f}, 0);
      vertices_[id].state = Vertex::State::kReal;
      vertices_[id].normal_W = CalcNormal(vertices_[id].p_W);
    }
  }

  /// Moves one vertex in so many to another place near its own.
  ///
  /// @returns The vertices that moved and those within R_max of one, before or after, in ascending order.
  std::vector<uint32_t> MoveSome(double share) {
    std::set<uint32_t> due;
    for (uint32_t id = 0; id < vertices_.size(); ++id) {
      if (CalcUniform({seed_, count_++}) >= share) continue;
      AddNear(id, due);
      vertices_.Move(id, MakePlace(places_[id]));
      vertices_[id].normal_W = CalcNormal(vertices_[id].p_W);
      AddNear(id, due);
    }
    return {due.begin(), due.end()};
  }

  std::vector<uint32_t> All() const {
    std::vector<uint32_t> ids(vertices_.size());
    for (uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
    return ids;
  }
  const VertexStore& vertices() const { return vertices_; }

 private:
  static constexpr int kEdge = 20;
  static constexpr float kSpacing_m = 0.003f;

  Vector3f MakePlace(int i) {
    const auto jitter = [&] { return static_cast<float>(CalcUniform({seed_, count_++}) - 0.5) * 1.1f; };
    const float x = kSpacing_m * (static_cast<float>(i / kEdge) + jitter());
    const float y = kSpacing_m * (static_cast<float>(i % kEdge) + jitter());
    return {x, y, 0.004f * std::sin(x / 0.006f) * std::cos(y / 0.007f)};
  }
  static Vector3f CalcNormal(const Vector3f& p_W) {
    const float x = p_W.x() / 0.006f, y = p_W.y() / 0.007f;
    return Vector3f(-0.004f / 0.006f * std::cos(x) * std::cos(y), 0.004f / 0.007f * std::sin(x) * std::sin(y), 1.0f)
        .normalized();
  }
  void AddNear(uint32_t id, std::set<uint32_t>& due) const {
    const float reach_m = TriangulationSettings{}.max_edge_m;
    vertices_.ForEachNear(vertices_[id].p_W, reach_m, [&](uint32_t other) {
      if ((vertices_[other].p_W - vertices_[id].p_W).norm() <= reach_m) due.insert(other);
    });
  }

  uint64_t seed_, count_ = 0;
  std::vector<int> places_;
  VertexStore vertices_{0.0046f};
};

std::set<Triangle> CollectTriangles(const StarTriangulation& triangulation) {
  std::set<Triangle> triangles;
  for (Triangle t : triangulation.topology().triangles()) {
    if (t[0] == t[1]) continue;
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.insert(t);
  }
  return triangles;
}

class RandomMoves : public testing::TestWithParam<uint64_t> {};

TEST_P(RandomMoves, LeaveWhatAllVerticesAtOnceWouldMake) {
  Hills hills(GetParam(), 0.0);
  const MeasurementMap measurements(0.002f);
  StarTriangulation triangulation(measurements, {});
  triangulation.Update(hills.All(), hills.vertices());
  for (int step = 0; step < 30; ++step) {
    triangulation.Update(hills.MoveSome(0.02), hills.vertices());
    const auto fault = FindFault(triangulation.topology().triangles(), hills.vertices());
    ASSERT_FALSE(fault) << *fault << " after step " << step;
    StarTriangulation at_once(measurements, {});
    at_once.Update(hills.All(), hills.vertices());
    const std::set<Triangle> kept = CollectTriangles(triangulation), made = CollectTriangles(at_once);
    ASSERT_GT(made.size(), 500u);
    std::vector<Triangle> different;
    std::set_symmetric_difference(kept.begin(), kept.end(), made.begin(), made.end(), std::back_inserter(different));
    ASSERT_EQ(different.size(), 0u) << "after step " << step << " of " << made.size() << " triangles";
  }
}

TEST_P(RandomMoves, LeaveASoundMeshAtRaggedBorders) {
  Hills hills(GetParam(), 0.3);
  const MeasurementMap measurements(0.002f);
  StarTriangulation triangulation(measurements, {});
  triangulation.Update(hills.All(), hills.vertices());
  for (int step = 0; step < 100; ++step) {
    triangulation.Update(hills.MoveSome(0.05), hills.vertices());
    const auto fault = FindFault(triangulation.topology().triangles(), hills.vertices());
    ASSERT_FALSE(fault) << *fault << " after step " << step;
    ASSERT_GT(triangulation.topology().triangle_count(), 50);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMoves, testing::Range<uint64_t>(1, 9));

/// A floor that goes on 4 mm beyond the foot of a wall, if there is one; vertex 0 lies 1.5 mm behind the foot. Not on a
/// grid, on which stars would not agree.
VertexStore MakeFloor(bool with_wall) {
  VertexStore vertices(0.005f);
  const auto add = [&](float x_mm, float y_mm, float z_mm, const Vector3f& normal_W) {
    const uint32_t id = vertices.Insert({1e-3f * Vector3f(x_mm, y_mm, z_mm), normal_W, 1e-4f}, 0);
    vertices[id].state = Vertex::State::kReal;
    vertices[id].normal_W = normal_W;
  };
  for (const float y : {0.1f, -10.0f, -8.0f, -6.0f, -4.0f, -2.0f, 2.0f, 4.0f, 6.0f, 8.0f, 10.0f}) {
    for (const float x : {1.5f, 4.0f, -1.0f, -3.5f, -6.0f}) add(x + 0.3f * std::sin(x + y), y, 0.0f, Vector3f::UnitZ());
    for (const float z : {1.5f, 3.5f, 5.5f}) {
      if (with_wall) add(0.0f, y, z, -Vector3f::UnitX());
    }
  }
  return vertices;
}

bool JoinsSomething(const VertexStore& vertices) {
  const MeasurementMap measurements(0.002f);
  StarTriangulation triangulation(measurements, {});
  std::vector<uint32_t> all(vertices.size());
  for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  triangulation.Update(all, vertices);
  return !triangulation.topology().TrianglesAt(0).empty();
}

/// Two points 5 mm from each other on walls that stand on the floor z = 0.
struct Walls {
  explicit Walls(bool facing) {
    const Vector3f normal_W = facing ? Vector3f::UnitX() : Vector3f(-Vector3f::UnitX());
    left.p_W = {-0.0025f, 0.0f, 0.002f};
    left.normal_W = normal_W;
    right.p_W = {0.0025f, 0.0f, 0.002f};
    right.normal_W = -normal_W;
  }
  bool MayBeBridged() const { return StarTriangulation(measurements, {}).MayBridge(left, right); }
  void Measure(float x, float z) { measurements.Insert({{x, 0.0f, z}, Vector3f::UnitZ(), 2e-4f}, Vector3f::UnitZ()); }

  MeasurementMap measurements{0.002f};
  Vertex left, right;
};

TEST(StarTriangulation, CreviceIsBridgedWhereItsGroundWasMeasured) {
  Walls walls(true);
  EXPECT_FALSE(walls.MayBeBridged());
  walls.Measure(0.0005f, 0.0f);
  EXPECT_TRUE(walls.MayBeBridged());
}

TEST(StarTriangulation, CreviceIsNotBridgedOverItsWallsAlone) {
  Walls walls(true);
  for (const float z : {0.0f, 0.002f, 0.004f}) {
    walls.Measure(-0.0025f, z);
    walls.Measure(0.0025f, z);
  }
  EXPECT_FALSE(walls.MayBeBridged());
}

TEST(StarTriangulation, CreviceIsNotBridgedFarAboveItsGround) {
  Walls walls(true);
  walls.Measure(0.0f, 0.002f - 1.1f * TriangulationSettings{}.ground_reach_m);
  EXPECT_FALSE(walls.MayBeBridged());
}

TEST(StarTriangulation, RimOfAPlateIsBridgedWithoutMeasurements) { EXPECT_TRUE(Walls(false).MayBeBridged()); }

TEST(StarTriangulation, VertexBehindASheetJoinsNothing) {
  EXPECT_FALSE(JoinsSomething(MakeFloor(true)));
  EXPECT_TRUE(JoinsSomething(MakeFloor(false)));
}

}  // namespace
}  // namespace nbs
