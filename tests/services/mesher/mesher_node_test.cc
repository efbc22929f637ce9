#include "services/mesher/mesher_node.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/services/mesher/synthetic_scan.h"

namespace nbs {
namespace {

Outbox Fold(MesherNode& node, const std::vector<Stripe>& stripes) {
  Outbox out;
  for (const Stripe& stripe : stripes) node.Handle(stripe, out);
  return out;
}

std::vector<Stripe> MakeScan(int32_t scan) {
  return ScanSolid(MakeSolidSphere(0.06), {},
                   {scan, {0.385, 0, -0.08}, {0.385, 0, 0.08}, {-1, 0, 0}, {0, 0, 0}, 0.002});
}

TEST(MesherNode, PublishesADeltaEach25StripesAndTheFiguresLast) {
  MesherNode node{RunConfig{}};
  const Outbox out = Fold(node, MakeScan(0));  // 81 stripes and the closing one.
  ASSERT_EQ(out.size(), 5u);
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(std::holds_alternative<MeshDelta>(out[i]));
    EXPECT_EQ(std::get<MeshDelta>(out[i]).end_of_scan, i == 3);
  }
  ASSERT_TRUE(std::holds_alternative<MeshScan>(out[4]));
  EXPECT_EQ(std::get<MeshScan>(out[4]).stripes, 81);
}

TEST(MesherNode, EmptyScanStillEndsWithADeltaAndFigures) {
  MesherNode node{RunConfig{}};
  Stripe closing;
  closing.end_of_scan = true;
  closing.utime_us = 40000;
  const Outbox out = Fold(node, {closing});
  ASSERT_EQ(out.size(), 2u);
  EXPECT_TRUE(std::get<MeshDelta>(out[0]).end_of_scan);
  EXPECT_EQ(std::get<MeshScan>(out[1]).completeness, 0.0);
}

TEST(MesherNode, TimesNeverFall) {
  MesherNode node{RunConfig{}};
  Outbox out = Fold(node, MakeScan(0));
  for (Message& message : Fold(node, MakeScan(1))) out.push_back(std::move(message));
  int64_t last = 0;
  for (const Message& message : out) {
    const int64_t utime = std::holds_alternative<MeshDelta>(message) ? std::get<MeshDelta>(message).utime_us
                                                                     : std::get<MeshScan>(message).utime_us;
    EXPECT_GE(utime, last);
    last = utime;
  }
}

TEST(MesherNode, RefusedStripeShowsInTheComplaints) {
  MesherNode node{RunConfig{}};
  auto stripes = MakeScan(0);
  stripes[5].X_WS.linear() *= 2.0;
  Fold(node, stripes);
  EXPECT_EQ(node.Complaints()[0].count, 1);
}

TEST(MesherNode, BadInputOfEachKindIsCountedAndTheMeshStaysSound) {
  MesherNode node{RunConfig{}};
  auto stripes = MakeScan(0);
  stripes[3].X_WS.translation().x() = std::numeric_limits<double>::quiet_NaN();
  stripes[7] = stripes[6];
  stripes[9].scan = 40'000;
  stripes[20].ranges_m[100] = std::numeric_limits<float>::quiet_NaN();
  stripes[21].ranges_m[100] = -0.3f;
  MeshReplica replica;
  for (const Message& message : Fold(node, stripes)) {
    if (const auto* delta = std::get_if<MeshDelta>(&message)) replica.Apply(*delta);
  }
  EXPECT_EQ(node.Complaints()[0].count, 3);
  EXPECT_EQ(node.Complaints()[1].count, 2);
  EXPECT_GT(replica.MakeCompactMesh().triangles.size(), 1000u);
}

}  // namespace
}  // namespace nbs
