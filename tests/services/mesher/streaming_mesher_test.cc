#include "services/mesher/streaming_mesher.h"

#include <gtest/gtest.h>

#include "tests/services/mesher/mesh_checks.h"
#include "tests/services/mesher/synthetic_scan.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr int kStripesPerUpdate = 25;

/// Folds whole sweeps, keeping a replica beside.
class Bench {
 public:
  explicit Bench(const Profiler& profiler = {}) : mesher(profiler, {}), profiler_(profiler) {}

  void Scan(const Solid& solid, const Sweep& sweep) {
    for (const Stripe& stripe : ScanSolid(solid, profiler_, sweep)) {
      mesher.AddStripe(stripe);
      if (stripe.end_of_scan || stripe.index % kStripesPerUpdate == kStripesPerUpdate - 1) {
        deltas.push_back(mesher.TakeDelta());
        replica.Apply(deltas.back());
      }
    }
  }
  void ScanAll(const Solid& solid, const std::vector<Sweep>& sweeps) {
    for (const Sweep& sweep : sweeps) Scan(solid, sweep);
  }

  StreamingMesher mesher;
  MeshReplica replica;
  std::vector<MeshDelta> deltas;

 private:
  Profiler profiler_;
};

Sweep MakeDownSweep(int32_t scan, double half_length_m, double height_m) {
  Sweep sweep;
  sweep.scan = scan;
  sweep.from_W = {0.0, -half_length_m, height_m};
  sweep.to_W = {0.0, half_length_m, height_m};
  sweep.view_W = -Vector3d::UnitZ();
  return sweep;
}

Solid MakeSquareSlab() { return MakeSolidBox({0, 0, -0.02}, {0.08, 0.08, 0.02}); }

TEST(StreamingMesher, FullyScannedSphereIsWatertight) {
  Bench bench;
  bench.ScanAll(MakeSolidSphere(0.06), MakeSweepsAround(0.06, 0.325, 6, 0.8));
  const MeshFigures figures = CountMesh(bench.mesher);
  EXPECT_EQ(figures.border_edges, 0);
  EXPECT_EQ(figures.doubled_edges, 0);
  EXPECT_EQ(bench.mesher.CalcScanFigures().completeness, 1.0);
  EXPECT_GT(figures.triangles, 8000);
}

TEST(StreamingMesher, MeanEdgeIsThreeMillimetresAndNoneExceedsItsLimit) {
  Bench bench;
  bench.ScanAll(MakeSolidSphere(0.06), MakeSweepsAround(0.06, 0.325, 6, 0.8));
  const MeshFigures figures = CountMesh(bench.mesher);
  EXPECT_NEAR(figures.mean_edge_m, 0.003, 0.00045);
  EXPECT_LE(figures.longest_edge_m, 0.0061);
}

TEST(StreamingMesher, VerticesLieNearerToTheSphereThanTheMeasurements) {
  Bench bench;
  bench.ScanAll(MakeSolidSphere(0.06), MakeSweepsAround(0.06, 0.325, 4, 0.8));
  double sum = 0.0;
  int count = 0;
  for (const MeshVertex& v : bench.replica.vertices()) {
    if (v.measurements == 0) continue;
    sum += std::pow(v.p_W.norm() - 0.06f, 2.0);
    ++count;
    EXPECT_GT(v.normal_W.dot(v.p_W.normalized()), 0.95f);
  }
  EXPECT_LT(std::sqrt(sum / count), 0.0001);  // The noise of a single measurement is 0.26 mm.
}

TEST(StreamingMesher, OneScanOfASlabHasOneBorderAndNoHoles) {
  Bench bench;
  bench.Scan(MakeSquareSlab(), MakeDownSweep(0, 0.12, 0.3));
  EXPECT_EQ(CalcLoopLengths(bench.mesher.topology().triangles()).size(), 1u);
  EXPECT_NEAR(CountMesh(bench.mesher).rim_length_m, 0.64, 0.08);
}

TEST(StreamingMesher, SidesOfAThinPlateAreNeverJoined) {
  Bench bench;
  const Solid plate = MakeSolidBox({0, 0, 0}, {0.06, 0.06, 0.0015});
  bench.Scan(plate, MakeDownSweep(0, 0.1, 0.3));
  Sweep below = MakeDownSweep(1, 0.1, -0.3);
  below.view_W = Vector3d::UnitZ();
  bench.Scan(plate, below);
  for (const auto& t : bench.mesher.topology().triangles()) {
    if (MeshReplica::IsEmpty(t)) continue;
    const auto side = [&](int i) { return bench.mesher.vertices()[t[i]].p_W.z() > 0.0f; };
    EXPECT_TRUE(side(0) == side(1) && side(1) == side(2));
  }
  EXPECT_EQ(CalcLoopLengths(bench.mesher.topology().triangles()).size(), 2u);
}

TEST(StreamingMesher, FacingWallsOfANarrowGapAreNotBridged) {
  Bench bench;
  const Solid walls =
      MakeUnion(MakeSolidBox({0.053, 0, 0}, {0.05, 0.08, 0.05}), MakeSolidBox({-0.053, 0, 0}, {0.05, 0.08, 0.05}));
  bench.Scan(walls, MakeDownSweep(0, 0.1, 0.35));
  Sweep tilted = MakeDownSweep(1, 0.1, 0.3);
  tilted.view_W = Vector3d(0.4, 0.0, -1.0);
  tilted.from_W.x() = tilted.to_W.x() = -0.12;
  bench.Scan(walls, tilted);
  for (const auto& t : bench.mesher.topology().triangles()) {
    if (MeshReplica::IsEmpty(t)) continue;
    int right = 0;
    for (uint32_t id : t) right += bench.mesher.vertices()[id].p_W.x() > 0.0f;
    EXPECT_TRUE(right == 0 || right == 3);
  }
}

TEST(StreamingMesher, FullyScannedCubeIsWatertight) {
  Bench bench;
  auto sweeps = MakeSweepsAround(0.05, 0.3, 8, 0.7);
  bench.ScanAll(MakeSolidBox({0, 0, 0}, {0.04, 0.04, 0.04}), sweeps);
  EXPECT_GT(bench.mesher.CalcScanFigures().completeness, 0.999);
}

TEST(StreamingMesher, SlotWiderThanTheLongestEdgeStaysOpen) {
  Bench bench;
  const Solid halves =
      MakeUnion(MakeSolidBox({0.05, 0, -0.2}, {0.045, 0.08, 0.2}), MakeSolidBox({-0.05, 0, -0.2}, {0.045, 0.08, 0.2}));
  bench.Scan(halves, MakeDownSweep(0, 0.12, 0.3));  // A slot 10 mm wide, too deep to see its ground.
  EXPECT_EQ(CalcLoopLengths(bench.mesher.topology().triangles()).size(), 2u);
}

TEST(StreamingMesher, StepWithAnUnseenWallIsNotBridged) {
  Bench bench;
  const Solid step = MakeUnion(MakeSolidBox({0.05, 0, -0.02}, {0.05, 0.08, 0.02}),
                               MakeSolidBox({-0.05, 0, -0.025}, {0.05, 0.08, 0.02}));
  bench.Scan(step, MakeDownSweep(0, 0.12, 0.3));
  for (const auto& t : bench.mesher.topology().triangles()) {
    if (MeshReplica::IsEmpty(t)) continue;
    int high = 0;
    for (uint32_t id : t) high += bench.mesher.vertices()[id].p_W.z() > -0.0025f;
    EXPECT_TRUE(high == 0 || high == 3);
  }
}

TEST(StreamingMesher, VerticesKeepTheirDistanceInHeavyNoise) {
  Profiler noisy;
  noisy.sigma_per_m = 0.008;  // 0.75 mm.
  Bench bench(noisy);
  bench.Scan(MakeSquareSlab(), MakeDownSweep(0, 0.12, 0.3));
  const VertexStore& vertices = bench.mesher.vertices();
  for (uint32_t a = 0; a < vertices.size(); ++a) {
    if (vertices[a].state != Vertex::State::kReal) continue;
    vertices.ForEachNear(vertices[a].p_W, 0.0013f, [&](uint32_t b) {
      if (b != a && vertices[b].state == Vertex::State::kReal) {
        EXPECT_GT((vertices[a].p_W - vertices[b].p_W).norm(), 0.0013f);
      }
    });
  }
}

TEST(StreamingMesher, SecondScanOffByAMillimetreMergesIntoOneSheet) {
  Bench bench;
  bench.Scan(MakeSquareSlab(), MakeDownSweep(0, 0.12, 0.3));
  const int64_t before = bench.mesher.CalcScanFigures().vertices;
  Sweep second = MakeDownSweep(1, 0.12, 0.3);
  second.offset_W = {0.0, 0.0, 0.001};
  bench.Scan(MakeSquareSlab(), second);
  EXPECT_LT(bench.mesher.CalcScanFigures().vertices, before * 21 / 20);
  EXPECT_EQ(CalcLoopLengths(bench.mesher.topology().triangles()).size(), 1u);
}

TEST(StreamingMesher, SingleOutliersNeverEnterTheMesh) {
  Bench bench;
  auto stripes = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(0, 0.12, 0.3));
  for (Stripe& stripe : stripes) {
    for (size_t i = 0; i < stripe.ranges_m.size(); ++i) {
      if (CalcUniform({9, static_cast<uint64_t>(stripe.index), i}) < 0.01) {
        stripe.ranges_m[i] = static_cast<float>(0.16 + 0.1 * CalcUniform({8, static_cast<uint64_t>(stripe.index), i}));
      }
    }
    bench.mesher.AddStripe(stripe);
  }
  for (uint32_t id = 0; id < bench.mesher.vertices().size(); ++id) {
    if (bench.mesher.vertices()[id].state != Vertex::State::kReal) continue;
    EXPECT_LT(std::abs(bench.mesher.vertices()[id].p_W.z()), 0.002f);
  }
  EXPECT_EQ(CalcLoopLengths(bench.mesher.topology().triangles()).size(), 1u);
}

TEST(StreamingMesher, MeasurementsThatNeverGetSupportAreForgotten) {
  StreamingMesherSettings settings;
  settings.forget_stripes = 100;
  const auto count_after = [&](int stripes_between) {
    StreamingMesher mesher({}, settings);
    const auto slab = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(0, 0.12, 0.3));
    int32_t scan = 0, index = 0;
    const auto add = [&](Stripe stripe) {
      stripe.scan = scan;
      stripe.index = index++;
      mesher.AddStripe(stripe);
    };
    const auto close = [&] {
      add(slab.back());
      ++scan;
      index = 0;
    };
    add(slab[60]);
    close();
    Stripe empty = slab[61];
    for (float& range : empty.ranges_m) range = 0.0f;
    for (int i = 0; i < stripes_between; ++i) add(empty);
    close();
    add(slab[61]);  // With stripe 60 enough for a surface, alone it is not.
    close();
    return mesher.CalcScanFigures().vertices;
  };
  EXPECT_GT(count_after(50), 50);
  EXPECT_EQ(count_after(150), 0);
}

TEST(StreamingMesher, OneStripeAloneMakesNoSurface) {
  Bench bench;
  auto stripes = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(0, 0.12, 0.3));
  bench.mesher.AddStripe(stripes[60]);
  bench.mesher.Update();
  EXPECT_EQ(bench.mesher.CalcScanFigures().vertices, 0);
}

TEST(StreamingMesher, MeshIsAManifoldAfterEachStripeAndTheReplicaEqualsIt) {
  const Solid solid = MakeUnion(MakeSolidSphere(0.03), MakeSolidBox({0.02, 0.0, 0.0}, {0.03, 0.01, 0.02}));
  StreamingMesher mesher({}, {});
  MeshReplica replica;
  for (int32_t scan = 0; scan < 6; ++scan) {
    const uint64_t n = static_cast<uint64_t>(scan);
    const Vector3d view =
        Vector3d(CalcGaussian({1, n, 0}), CalcGaussian({1, n, 1}), CalcGaussian({1, n, 2})).normalized();
    const Vector3d along = view.unitOrthogonal();
    for (const Stripe& stripe :
         ScanSolid(solid, {},
                   {scan, -0.3 * view - 0.06 * along, -0.3 * view + 0.06 * along, view, Vector3d::Zero(), 0.002})) {
      mesher.AddStripe(stripe);
      replica.Apply(mesher.TakeDelta());
      ASSERT_EQ(CountMesh(mesher).doubled_edges, 0);
      ASSERT_EQ(CountMesh(mesher).bow_ties, 0);
      ASSERT_TRUE(HasSameTriangles(replica, mesher));
    }
    for (const MeshVertex& v : replica.vertices()) {
      if (v.measurements > 0) {
        ASSERT_EQ(v.p_W, mesher.vertices()[v.id].p_W);
      }
    }
  }
}

TEST(StreamingMesher, FiguresEqualThoseCountedFromScratch) {
  Bench bench;
  for (int scan = 0; scan < 3; ++scan) {
    bench.Scan(MakeSolidSphere(0.05), MakeSweepsAround(0.05, 0.3, 3, 0.7)[static_cast<size_t>(scan)]);
    const MeshFigures counted = CountMesh(bench.mesher);
    const MeshScan figures = bench.mesher.CalcScanFigures();
    EXPECT_EQ(figures.triangles, counted.triangles);
    EXPECT_EQ(figures.edges, counted.edges);
    EXPECT_EQ(figures.border_edges, counted.border_edges);
    EXPECT_NEAR(figures.rim_length_m, counted.rim_length_m, 1e-6);
    EXPECT_NEAR(figures.completeness,
                1.0 - static_cast<double>(counted.border_edges) / static_cast<double>(counted.edges), 1e-12);
  }
}

TEST(StreamingMesher, SameStripesTwiceGiveTheSameDeltas) {
  Bench a, b;
  for (Bench* bench : {&a, &b}) bench->ScanAll(MakeSolidSphere(0.05), MakeSweepsAround(0.05, 0.3, 2, 0.7));
  EXPECT_EQ(a.deltas, b.deltas);
}

TEST(StreamingMesher, OrderOfTheScansHardlyChangesTheMeshedArea) {
  Bench forward, backward;
  auto sweeps = MakeSweepsAround(0.05, 0.3, 3, 0.7);
  forward.ScanAll(MakeSolidSphere(0.05), sweeps);
  std::reverse(sweeps.begin(), sweeps.end());
  for (size_t i = 0; i < sweeps.size(); ++i) sweeps[i].scan = static_cast<int32_t>(i);
  backward.ScanAll(MakeSolidSphere(0.05), sweeps);
  EXPECT_NEAR(CountMesh(backward.mesher).area_m2, CountMesh(forward.mesher).area_m2,
              0.01 * CountMesh(forward.mesher).area_m2);
}

TEST(StreamingMesher, BadRangesAreRefusedAndCounted) {
  Bench bench;
  Stripe stripe = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(0, 0.01, 0.3))[0];
  stripe.ranges_m[0] = -1.0f;
  stripe.ranges_m[1] = std::numeric_limits<float>::quiet_NaN();
  stripe.ranges_m[2] = std::numeric_limits<float>::infinity();
  stripe.ranges_m[3] = 1e30f;
  EXPECT_TRUE(bench.mesher.AddStripe(stripe));
  EXPECT_EQ(bench.mesher.counts().refused_measurements, 4);
}

TEST(StreamingMesher, BadStripesAreRefusedAndCounted) {
  Bench bench;
  const auto stripes = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(0, 0.01, 0.3));
  EXPECT_TRUE(bench.mesher.AddStripe(stripes[0]));
  EXPECT_FALSE(bench.mesher.AddStripe(stripes[0])) << "repeated";
  Stripe skewed = stripes[1];
  skewed.X_WS.linear()(0, 0) += 0.1;
  EXPECT_FALSE(bench.mesher.AddStripe(skewed));
  Stripe lost = stripes[1];
  lost.X_WS.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bench.mesher.AddStripe(lost));
  Stripe cut = stripes[1];
  cut.ranges_m.pop_back();
  EXPECT_FALSE(bench.mesher.AddStripe(cut));
  EXPECT_EQ(bench.mesher.counts().refused_stripes, 4);
  EXPECT_TRUE(bench.mesher.AddStripe(stripes[1]));
}

TEST(StreamingMesher, StripesOfUnknownScansAreRefusedAndShutNothingOut) {
  Bench bench;
  auto stripes = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(3, 0.01, 0.3));
  for (Stripe& stripe : stripes) EXPECT_TRUE(bench.mesher.AddStripe(stripe));
  for (int32_t scan : {-1, 2, 3, 20, 60'000, 70'000}) {
    Stripe stripe = stripes[0];
    stripe.scan = scan;
    EXPECT_FALSE(bench.mesher.AddStripe(stripe)) << scan;
  }
  EXPECT_EQ(bench.mesher.counts().refused_stripes, 6);
  EXPECT_EQ(bench.mesher.CalcScanFigures().refused, 6);
  Stripe next = stripes[0];
  next.scan = 4;
  EXPECT_TRUE(bench.mesher.AddStripe(next));
}

TEST(StreamingMesher, MeshIsTheSameWithBadInputBetweenTheStripes) {
  Bench clean, disturbed;
  const auto stripes = ScanSolid(MakeSquareSlab(), {}, MakeDownSweep(0, 0.05, 0.3));
  for (const Stripe& stripe : stripes) {
    clean.mesher.AddStripe(stripe);
    Stripe bad = stripe;
    bad.X_WS.linear() *= 1.1;
    EXPECT_EQ(disturbed.mesher.AddStripe(bad), stripe.end_of_scan) << "the pose of a closing stripe does not matter";
    if (stripe.end_of_scan) break;
    bad = stripe;
    bad.X_WS.translation().y() = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(disturbed.mesher.AddStripe(bad));
    bad = stripe;
    bad.scan = -1;
    EXPECT_FALSE(disturbed.mesher.AddStripe(bad));
    EXPECT_TRUE(disturbed.mesher.AddStripe(stripe));
    EXPECT_FALSE(disturbed.mesher.AddStripe(stripe)) << "twice";
  }
  EXPECT_EQ(clean.mesher.TakeDelta(), disturbed.mesher.TakeDelta());
  EXPECT_EQ(disturbed.mesher.counts().refused_stripes, 4 * static_cast<int64_t>(stripes.size() - 1));
}

TEST(StreamingMesher, DeltaWithoutNewStripesIsEmpty) {
  Bench bench;
  bench.Scan(MakeSquareSlab(), MakeDownSweep(0, 0.12, 0.3));
  const MeshDelta delta = bench.mesher.TakeDelta();
  EXPECT_TRUE(delta.vertices.empty());
  EXPECT_TRUE(delta.triangles.empty());
}

TEST(StreamingMesher, VerticesComeBeforeTheTrianglesThatUseThem) {
  Bench bench;
  bench.Scan(MakeSquareSlab(), MakeDownSweep(0, 0.12, 0.3));
  MeshReplica replica;
  for (const MeshDelta& delta : bench.deltas) {
    replica.Apply(delta);
    for (const auto& t : replica.triangles()) {
      if (MeshReplica::IsEmpty(t)) continue;
      for (uint32_t id : t) {
        ASSERT_LT(id, replica.vertices().size());
        ASSERT_GT(replica.vertices()[id].measurements, 0);
      }
    }
  }
}

}  // namespace
}  // namespace nbs
