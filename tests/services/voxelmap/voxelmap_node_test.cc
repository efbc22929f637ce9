#include "services/voxelmap/voxelmap_node.h"

#include <gtest/gtest.h>

#include <limits>

namespace nbs {
namespace {

RunConfig MakeConfig() {
  RunConfig config;
  config.grid = {Eigen::Vector3d::Constant(-0.1), 0.005, Eigen::Vector3i::Constant(40)};
  return config;
}

Stripe MakeStripe(int scan, int index) {
  Stripe stripe;
  stripe.utime_us = 1000000 * scan + 40000 * index;
  stripe.scan = scan;
  stripe.index = index;
  stripe.X_WS = MakeLookPose({0.0, -0.3, 0.002 * index - 0.1}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
  stripe.ranges_m.assign(Profiler().points, 0.3F);
  return stripe;
}

Stripe MakeClosingStripe(int scan, int index) {
  Stripe stripe;
  stripe.utime_us = 1000000 * scan + 40000 * index;
  stripe.scan = scan;
  stripe.index = index;
  stripe.end_of_scan = true;
  return stripe;
}

int64_t CountComplaints(const VoxelmapNode& node) {
  int64_t sum = 0;
  for (const Node::Count& count : node.Complaints()) sum += count.count;
  return sum;
}

TEST(VoxelmapNode, ReadsStripesForEver) {
  VoxelmapNode node(MakeConfig());
  Outbox out;
  node.Start(out);
  EXPECT_EQ(node.NextInput(), StreamOf<Stripe>());
  node.Handle(MakeClosingStripe(0, 0), out);
  EXPECT_EQ(node.NextInput(), StreamOf<Stripe>());
}

TEST(VoxelmapNode, PublishesEvery25StripesAndAtTheEndOfAScan) {
  VoxelmapNode node(MakeConfig());
  Outbox out;
  for (int i = 0; i < 60; ++i) node.Handle(MakeStripe(0, i), out);
  node.Handle(MakeClosingStripe(0, 60), out);
  ASSERT_EQ(out.size(), 3U);
  const std::vector<int64_t> utimes = {24 * 40000, 49 * 40000, 60 * 40000};
  VoxelGrid replica(MakeConfig().grid);
  for (size_t i = 0; i < out.size(); ++i) {
    const auto& delta = std::get<VoxelDelta>(out[i]);
    EXPECT_EQ(delta.utime_us, utimes[i]);
    EXPECT_EQ(delta.end_of_scan, i == 2);
    replica.Apply(delta);
  }
  EXPECT_EQ(replica, node.grid());
}

TEST(VoxelmapNode, AnEmptyScanStillEndsWithADelta) {
  VoxelmapNode node(MakeConfig());
  Outbox out;
  node.Handle(MakeClosingStripe(3, 0), out);
  ASSERT_EQ(out.size(), 1U);
  const auto& delta = std::get<VoxelDelta>(out[0]);
  EXPECT_TRUE(delta.end_of_scan);
  EXPECT_EQ(delta.scan, 3);
  EXPECT_TRUE(delta.values.empty());
}

TEST(VoxelmapNode, RefusesAndCountsBadStripesAndKeepsItsMap) {
  VoxelmapNode node(MakeConfig());
  Outbox out;
  node.Handle(MakeStripe(1, 4), out);
  const VoxelGrid before = node.grid();
  Stripe not_finite = MakeStripe(1, 5), infinite = MakeStripe(1, 5), negative = MakeStripe(1, 5),
         few = MakeStripe(1, 5), skewed = MakeStripe(1, 5);
  not_finite.ranges_m[7] = std::numeric_limits<float>::quiet_NaN();
  infinite.ranges_m[7] = std::numeric_limits<float>::infinity();
  negative.ranges_m[7] = -0.3F;
  few.ranges_m.pop_back();
  skewed.X_WS.linear()(0, 0) = 2.0;
  const Stripe twice = MakeStripe(1, 4), earlier_scan = MakeStripe(0, 9);
  int64_t complaints = 0;
  for (const Stripe& bad : {not_finite, infinite, negative, few, skewed, twice, earlier_scan}) {
    node.Handle(bad, out);
    EXPECT_EQ(CountComplaints(node), ++complaints);
    EXPECT_EQ(node.grid(), before);
  }
  node.Handle(MakeStripe(1, 5), out);
  EXPECT_EQ(CountComplaints(node), complaints);
}

TEST(VoxelmapNode, RefusesStripesOfAClosedScan) {
  VoxelmapNode node(MakeConfig());
  Outbox out;
  node.Handle(MakeClosingStripe(0, 0), out);
  node.Handle(MakeStripe(0, 1), out);
  node.Handle(MakeClosingStripe(0, 2), out);
  EXPECT_EQ(out.size(), 1U);
  EXPECT_EQ(CountComplaints(node), 2);
}

TEST(VoxelmapNode, TheSameStripesGiveTheSameDeltas) {
  const auto run = [] {
    VoxelmapNode node(MakeConfig());
    Outbox out;
    for (int scan = 0; scan < 2; ++scan) {
      for (int i = 0; i < 60; ++i) node.Handle(MakeStripe(scan, i), out);
      node.Handle(MakeClosingStripe(scan, 60), out);
    }
    return out;
  };
  const Outbox first = run(), second = run();
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(std::get<VoxelDelta>(first[i]), std::get<VoxelDelta>(second[i]));
}

}  // namespace
}  // namespace nbs
