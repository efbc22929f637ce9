#include "services/voxelmap/map_update.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace nbs {
namespace {

/// A box of 0.3 m around W's origin.
GridShape MakeShape() { return {Eigen::Vector3d::Constant(-0.15), 0.005, Eigen::Vector3i::Constant(60)}; }

/// A stripe of a sensor at p_WS that looks along `view_W` at the plane through `p_WP` with normal `n_W`.
Stripe MakeStripe(const Profiler& profiler, const Eigen::Vector3d& p_WS, const Eigen::Vector3d& view_W,
                  const Eigen::Vector3d& scan_W, const Eigen::Vector3d& p_WP, const Eigen::Vector3d& n_W) {
  Stripe stripe;
  stripe.X_WS = MakeLookPose(p_WS, view_W, scan_W);
  for (const Eigen::Vector3d& beam_S : CalcBeamDirections_S(profiler)) {
    const Eigen::Vector3d beam_W = stripe.X_WS.linear() * beam_S;
    const double range = (p_WP - p_WS).dot(n_W) / beam_W.dot(n_W);
    const double depth = range * beam_S.z();
    const bool returns = range > 0.0 && depth >= profiler.min_depth_m && depth <= profiler.max_depth_m &&
                         std::abs(beam_W.dot(n_W)) >= std::cos(profiler.max_incidence_rad);
    stripe.ranges_m.push_back(returns ? static_cast<float>(range) : 0.0F);
  }
  return stripe;
}

/// The sensor 0.3 m in front of the plane y = 0.0025 (the middle of a layer of cells), looking along +y, `height` above
/// W's origin.
Stripe MakeWallStripe(const Profiler& profiler, double height) {
  return MakeStripe(profiler, {0.0, -0.3, height}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                    {0.0, 0.0025, 0.0}, Eigen::Vector3d::UnitY());
}

TEST(MapUpdate, OneHitMakesACellOccupied) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  map.Insert(MakeWallStripe(profiler, 0.0025));
  for (int x = 10; x < 50; ++x) EXPECT_TRUE(IsOccupied(map.grid().At(x, 30, 30))) << x;
}

TEST(MapUpdate, LeavesWhatIsBehindTheHitUnobserved) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  for (int i = 0; i < 20; ++i) map.Insert(MakeWallStripe(profiler, 0.002 * i));
  for (int z = 0; z < 60; ++z) {
    for (int y = 31; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) ASSERT_EQ(map.grid().At(x, y, z), kUnobserved);
    }
  }
}

TEST(MapUpdate, AScanLeavesNoHalfKnownCellsInTheVolumeThatItSwept) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  for (int i = -50; i <= 50; ++i) map.Insert(MakeWallStripe(profiler, 0.002 * i));
  for (int z = 15; z < 45; ++z) {
    for (int y = 0; y < 30; ++y) {
      for (int x = 15; x < 45; ++x)
        ASSERT_LE(CalcProbability(map.grid().At(x, y, z)), 0.02) << x << " " << y << " " << z;
    }
    for (int x = 15; x < 45; ++x) ASSERT_TRUE(IsOccupied(map.grid().At(x, 30, z)));
  }
}

TEST(MapUpdate, AStripeWithoutReturnsChangesNothing) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  map.Insert(MakeWallStripe(profiler, 0.0));
  (void)map.TakeDelta();
  const VoxelGrid before = map.grid();
  Stripe empty = MakeWallStripe(profiler, 0.01);
  std::ranges::fill(empty.ranges_m, 0.0F);
  map.Insert(empty);
  EXPECT_EQ(map.grid(), before);
  EXPECT_TRUE(map.TakeDelta().run_start.empty());
}

TEST(MapUpdate, DoesNotDependOnTheOrderOfTheBeamsOfAStripe) {
  // Seen from behind its x axis a stripe has its beams in the opposite order.
  const Profiler profiler;
  MapUpdate forward(MakeShape(), profiler), backward(MakeShape(), profiler);
  for (int i = -20; i <= 20; ++i) {
    const Eigen::Vector3d p_WS(0.0, -0.3, 0.002 * i), view_W(0.0, 1.0, 0.3), n_W(0.3, 1.0, 0.2);
    forward.Insert(MakeStripe(profiler, p_WS, view_W, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), n_W));
    Stripe turned = MakeStripe(profiler, p_WS, view_W, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), n_W);
    turned.X_WS.linear().col(0) *= -1.0;
    turned.X_WS.linear().col(1) *= -1.0;
    std::ranges::reverse(turned.ranges_m);
    backward.Insert(turned);
  }
  const auto differences = [&] {
    int64_t count = 0;
    for (size_t i = 0; i < forward.grid().cells().size(); ++i)
      count += forward.grid().cells()[i] != backward.grid().cells()[i];
    return count;
  }();
  // Directions of mirrored beams differ in the last bit; a handful of crossings may be near ties.
  EXPECT_LE(differences, 2);
}

TEST(MapUpdate, SeveralBeamsOfAStripeInACellAreOneObservation) {
  Profiler few, many;
  few.points = 5;
  many.points = 401;
  many.fan_rad = few.fan_rad = 0.02;
  MapUpdate map_few(MakeShape(), few), map_many(MakeShape(), many);
  map_few.Insert(MakeWallStripe(few, 0.0025));
  map_many.Insert(MakeWallStripe(many, 0.0025));
  EXPECT_EQ(map_few.grid().At(30, 10, 30), map_many.grid().At(30, 10, 30));
  EXPECT_EQ(map_few.grid().At(30, 30, 30), map_many.grid().At(30, 30, 30));
  EXPECT_EQ(map_few.grid().At(30, 10, 30), -2048);
}

TEST(MapUpdate, AHitWinsOverAPassInTheSameStripe) {
  // The wall recedes along the stripe, so that neighbouring beams pass the cells that others hit.
  const Profiler profiler;
  const Eigen::Vector3d n_W = Eigen::Vector3d(1.5, 1.0, 0.0).normalized();
  MapUpdate map(MakeShape(), profiler);
  const Stripe stripe = MakeStripe(profiler, {0.0, -0.3, 0.0025}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                                   Eigen::Vector3d::Zero(), n_W);
  map.Insert(stripe);
  int hits = 0;
  for (int i = 0; i < profiler.points; ++i) {
    const int64_t cell =
        FindCell(map.grid().shape(), stripe.X_WS * (stripe.ranges_m[i] * CalcBeamDirection_S(profiler, i)));
    if (stripe.ranges_m[i] == 0.0F || cell < 0) continue;
    ++hits;
    EXPECT_TRUE(IsOccupied(map.grid().cells()[cell]));
  }
  EXPECT_GT(hits, 50);
}

TEST(MapUpdate, ObliqueScansDoNotEatTheSurface) {
  const Profiler profiler;
  for (const double incidence_deg : {0.0, 30.0, 50.0, 60.0, 68.0}) {
    const double angle = incidence_deg * std::numbers::pi / 180.0;
    const Eigen::Vector3d view_W(0.0, std::cos(angle), std::sin(angle)), n_W = Eigen::Vector3d::UnitY();
    MapUpdate map(MakeShape(), profiler);
    std::vector<int64_t> hits;
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d p_WS = -0.3 * view_W + Eigen::Vector3d(0.0, 0.0, 0.001 * (i - 150));
      const Stripe stripe = MakeStripe(profiler, p_WS, view_W, Eigen::Vector3d::UnitZ(), {0.0, 0.0037, 0.0}, n_W);
      map.Insert(stripe);
      for (const Eigen::Vector3d& p_W :
           CalcStripeEvidence(profiler, CalcBeamDirections_S(profiler), 3.0, stripe).hits_W) {
        hits.push_back(FindCell(map.grid().shape(), p_W));
      }
    }
    EXPECT_GT(hits.size(), 1000U);
    for (const int64_t index : hits) ASSERT_TRUE(index < 0 || IsOccupied(map.grid().cells()[index])) << incidence_deg;
  }
}

TEST(MapUpdate, PassesDoNotWeakenACellInAScanThatHitIt) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  Stripe near = MakeWallStripe(profiler, 0.0025);
  for (float& range : near.ranges_m) range -= 0.05F;
  map.Insert(near);
  const int16_t after_hit = map.grid().At(30, 20, 30);
  for (int i = 0; i < 10; ++i) map.Insert(MakeWallStripe(profiler, 0.0025));
  EXPECT_EQ(map.grid().At(30, 20, 30), after_hit);
}

TEST(MapUpdate, FreesUpToTheCellBeforeThatOfZMinusKSigma) {
  // The wall stands 0.5 mm behind a face, 3 sigma are 0.69 mm: the cell before the face is left alone.
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  map.Insert(MakeStripe(profiler, {0.0, -0.3, 0.0025}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                        {0.0, 0.0005, 0.0}, Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(IsOccupied(map.grid().At(30, 30, 30)));
  EXPECT_EQ(map.grid().At(30, 29, 30), kUnobserved);
  EXPECT_EQ(map.grid().At(30, 28, 30), -2048);
}

TEST(MapUpdate, TwoScansThatPassACellAndNeverHitItClearIt) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  Stripe outlier = MakeWallStripe(profiler, 0.0025);
  for (float& range : outlier.ranges_m) range -= 0.05F;
  map.Insert(outlier);
  const auto cell = [&] { return map.grid().At(30, 20, 30); };
  ASSERT_TRUE(IsOccupied(cell()));
  for (int scan = 1; scan <= 2; ++scan) {
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(IsOccupied(cell()), scan == 1 || i == 0) << "scan " << scan << " stripe " << i;
      Stripe stripe = MakeWallStripe(profiler, 0.0025);
      stripe.scan = scan;
      map.Insert(stripe);
    }
  }
  EXPECT_LE(CalcProbability(cell()), 0.02);
}

TEST(MapUpdate, StaysWithinTheClamps) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  for (int i = 0; i < 50; ++i) map.Insert(MakeWallStripe(profiler, 0.0025));
  const LogOddsSteps steps = MakeLogOddsSteps({});
  EXPECT_EQ(map.grid().At(30, 10, 30), steps.lowest);
  EXPECT_EQ(map.grid().At(30, 30, 30), steps.highest);
}

TEST(MapUpdate, TheDeltasCarryAReplica) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  VoxelGrid replica(MakeShape());
  for (int i = -60; i <= 60; ++i) {
    map.Insert(MakeWallStripe(profiler, 0.002 * i));
    if (i % 7 == 0) replica.Apply(map.TakeDelta());
  }
  replica.Apply(map.TakeDelta());
  EXPECT_EQ(replica, map.grid());
}

TEST(MapUpdate, IsTheSameWithEveryInstructionSet) {
  const Profiler profiler;
  const auto run = [&](LaneSet lanes) {
    MapUpdate map(MakeShape(), profiler, {}, lanes);
    for (int i = -20; i <= 20; ++i) {
      const Eigen::Vector3d p_WS(0.0, -0.3, 0.002 * i), view_W(0.1, 1.0, 0.3), n_W(0.3, 1.0, 0.2);
      map.Insert(MakeStripe(profiler, p_WS, view_W, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), n_W));
    }
    return map.grid();
  };
  const VoxelGrid portable = run(LaneSet::kSse42);
  EXPECT_GT(std::ranges::count_if(portable.cells(), IsOccupied), 100);
  for (const LaneSet lanes : kLaneSets) {
    if (!IsSupported(lanes)) continue;
    EXPECT_EQ(run(lanes), portable) << ToString(lanes);
  }
}

TEST(MapUpdate, BeamsThatStayOutsideOfTheGridChangeNothing) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  map.Insert(MakeStripe(profiler, {0.0, 0.5, 0.0025}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                        {0.0, 0.8, 0.0}, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(map.grid(), VoxelGrid(MakeShape()));
  EXPECT_TRUE(map.TakeDelta().values.empty());
}

TEST(MapUpdate, BeamsFromInsideOfAnOccupiedCellStillCountAsPasses) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  // Something stood where the emitter is now: two scans later it does not.
  Stripe before = MakeWallStripe(profiler, 0.0025);
  for (float& range : before.ranges_m) range -= 0.14F;
  map.Insert(before);
  ASSERT_TRUE(IsOccupied(map.grid().At(30, 2, 30)));
  for (int scan = 1; scan <= 2; ++scan) {
    for (int i = 0; i < 3; ++i) {
      Stripe stripe = MakeStripe(profiler, {0.0, -0.1375, 0.0025}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                                 {0.0, 0.1, 0.0}, Eigen::Vector3d::UnitY());
      stripe.scan = scan;
      map.Insert(stripe);
    }
  }
  EXPECT_FALSE(IsOccupied(map.grid().At(30, 2, 30)));
}

TEST(MapUpdate, AHitBehindTheGridFreesTheGrid) {
  const Profiler profiler;
  MapUpdate map(MakeShape(), profiler);
  map.Insert(MakeStripe(profiler, {0.0, -0.25, 0.0025}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                        {0.0, 0.2, 0.0}, Eigen::Vector3d::UnitY()));
  for (int y = 0; y < 60; ++y) EXPECT_EQ(map.grid().At(30, y, 30), -2048) << y;
}

}  // namespace
}  // namespace nbs
