// Random stripes, and a mesh that is sound after each of them.

#include "tests/services/mesher/mesh_invariants.h"

#include <gtest/gtest.h>

#include "tests/services/mesher/mesh_checks.h"
#include "tests/services/mesher/synthetic_scan.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// Random numbers of one seed.
class Dice {
 public:
  explicit Dice(uint64_t seed) : seed_(seed) {}
  double Uniform(double low, double high) { return low + (high - low) * CalcUniform({seed_, count_++}); }
  bool Chance(double share) { return Uniform(0.0, 1.0) < share; }
  Vector3d Direction() {
    Vector3d d;
    for (int i = 0; i < 3; ++i) d[i] = CalcGaussian({seed_, count_++});
    return d.normalized();
  }

 private:
  uint64_t seed_, count_ = 0;
};

Solid MakeRandomSolid(Dice& dice) {
  Solid solid = MakeSolidSphere(dice.Uniform(0.01, 0.03));
  for (int i = 0; i < 3; ++i) {
    const Vector3d half(dice.Uniform(0.001, 0.02), dice.Uniform(0.001, 0.02), dice.Uniform(0.001, 0.02));
    solid = MakeUnion(solid, MakeSolidBox(dice.Uniform(0.0, 0.03) * dice.Direction(), half));
  }
  return solid;
}

/// A sweep from anywhere, in steps of any width, with poses up to 1 mm off; stripes are lost, come in disorder and hold
/// wrong ranges.
std::vector<Stripe> MakeRandomScan(int32_t scan, const Solid& solid, Dice& dice) {
  Sweep sweep;
  sweep.scan = scan;
  sweep.view_W = dice.Direction();
  const Vector3d along = sweep.view_W.unitOrthogonal(), middle = -dice.Uniform(0.22, 0.4) * sweep.view_W;
  sweep.from_W = middle - 0.04 * along;
  sweep.to_W = middle + 0.04 * along;
  sweep.offset_W = dice.Uniform(0.0, 0.001) * dice.Direction();
  sweep.step_m = dice.Uniform(0.0005, 0.004);
  std::vector<Stripe> stripes = ScanSolid(solid, {}, sweep);
  std::erase_if(stripes, [&](const Stripe& stripe) { return !stripe.end_of_scan && dice.Chance(0.1); });
  for (size_t i = 1; i + 1 < stripes.size(); ++i) {
    if (dice.Chance(0.1))
      std::swap(stripes[i], stripes[static_cast<size_t>(dice.Uniform(0.0, static_cast<double>(i)))]);
    for (float& range : stripes[i].ranges_m) {
      if (dice.Chance(0.01)) range *= static_cast<float>(dice.Uniform(0.97, 1.03));
    }
  }
  for (size_t i = 0; i < stripes.size(); ++i) stripes[i].index = static_cast<int32_t>(i);
  return stripes;
}

class RandomStripes : public testing::TestWithParam<uint64_t> {};

TEST_P(RandomStripes, LeaveASoundMeshAfterEach) {
  Dice dice(GetParam());
  const Solid solid = MakeRandomSolid(dice);
  StreamingMesher mesher({}, {});
  MeshReplica replica;
  for (int32_t scan = 0; scan < 8; ++scan) {
    for (const Stripe& stripe : MakeRandomScan(scan, solid, dice)) {
      ASSERT_TRUE(mesher.AddStripe(stripe));
      const auto fault = FindFault(mesher.topology().triangles(), mesher.vertices());
      ASSERT_FALSE(fault) << *fault << " after stripe " << stripe.index << " of scan " << scan;
      if (dice.Chance(0.1) || stripe.end_of_scan) {
        replica.Apply(mesher.TakeDelta());
        ASSERT_TRUE(HasSameTriangles(replica, mesher));
      }
    }
    const MeshFigures counted = CountMesh(mesher);
    ASSERT_EQ(mesher.CalcScanFigures().border_edges, counted.border_edges);
    ASSERT_EQ(mesher.CalcScanFigures().edges, counted.edges);
  }
  EXPECT_GT(mesher.topology().triangle_count(), 300);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomStripes, testing::Range<uint64_t>(1, 13));

/// Four triangles around vertex 4, on a flat square of 4 mm.
class FindFaultTest : public testing::Test {
 protected:
  FindFaultTest() {
    for (const auto& [x, y] : {std::pair(-2, -2), {2, -2}, {2, 2}, {-2, 2}, {0, 0}, {0, 4}}) {
      const uint32_t id = vertices_.Insert({1e-3f * Eigen::Vector3f(x, y, 0), Eigen::Vector3f::UnitZ(), 1e-4f}, 0);
      vertices_[id].state = Vertex::State::kReal;
      vertices_[id].normal_W = Eigen::Vector3f::UnitZ();
    }
  }

  VertexStore vertices_{0.005f};
  std::vector<std::array<uint32_t, 3>> triangles_{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
};

TEST_F(FindFaultTest, SoundMeshHasNone) { EXPECT_FALSE(FindFault(triangles_, vertices_)); }

TEST_F(FindFaultTest, TriangleTurnedOverIsFound) {
  std::swap(triangles_[1][0], triangles_[1][1]);
  EXPECT_TRUE(FindFault(triangles_, vertices_));
}

TEST_F(FindFaultTest, ThirdTriangleAtAnEdgeIsFound) {
  triangles_.push_back({0, 4, 5});
  triangles_.push_back({4, 0, 5});
  EXPECT_TRUE(FindFault(triangles_, vertices_));
}

TEST_F(FindFaultTest, SecondFanIsFound) {
  triangles_ = {{0, 1, 4}, {2, 3, 4}};
  EXPECT_EQ(FindFault(triangles_, vertices_), "vertex 4 has two fans");
}

TEST_F(FindFaultTest, TriangleThatWasNotMadeAnewWhenItsVertexMovedIsFound) {
  vertices_.Move(4, {0.0f, 0.0035f, 0.0f});
  EXPECT_EQ(FindFault(triangles_, vertices_), "a triangle at vertex 2 faces away");
}

TEST_F(FindFaultTest, VertexThatIsNoMoreIsFound) {
  vertices_.Remove(4);
  EXPECT_EQ(FindFault(triangles_, vertices_), "vertex 4 is none");
}

}  // namespace
}  // namespace nbs
