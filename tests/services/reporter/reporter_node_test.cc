#include "services/reporter/reporter_node.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

TEST(ReporterNode, LeavesOutDamagedDeltasCountsThemAndGoesOn) {
  GridShape grid;
  grid.size = {4, 4, 4};
  ReporterNode reporter(grid, {}, nullptr);
  Outbox out;
  reporter.Handle(RunState{1, 0, RunPhase::kScanning, PlanMode::kFirst, false, {}, {}}, out);
  reporter.Handle(Execution{1, 0, true, {}}, out);
  reporter.Handle(MeshDelta{1, 0, true, {}, {{0, {0, 1, 2}}}}, out);
  reporter.Handle(VoxelDelta{1, 0, true, {64}, {1}, {100}}, out);
  reporter.Handle(MeshScan{}, out);
  EXPECT_EQ(reporter.record().scans.size(), 1u);
  EXPECT_TRUE(reporter.mesh().triangles().empty());
  for (const Node::Count& count : reporter.Complaints()) EXPECT_EQ(count.count, 1) << count.name;
  EXPECT_EQ(reporter.Complaints().size(), 2u);
}

}  // namespace
}  // namespace nbs
