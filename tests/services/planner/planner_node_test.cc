#include "services/planner/planner_node.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

RunConfig MakeConfig() {
  RunConfig config;
  config.cell = ReadCellConfig(NBS_SOURCE_DIR "/sim/cells/free.yaml");
  config.gain = ToString(GainRule::kSum);
  ResolvePlacement({Eigen::Vector3d(-0.05, -0.05, 0.0), Eigen::Vector3d(0.05, 0.05, 0.1)}, config);
  return config;
}

class PlannerThatIsAsked : public testing::Test {
 protected:
  Plan Ask(int32_t scan, PlanMode mode) {
    Outbox out;
    planner_.Handle(PlanRequest{1, scan, mode}, out);
    return std::get<Plan>(out.at(1));
  }
  void Tell(const Message& message) {
    Outbox out;
    planner_.Handle(message, out);
  }
  int64_t CountComplaint(std::string_view name) const {
    for (const Node::Count& count : planner_.Complaints()) {
      if (count.name == name) return count.count;
    }
    return -1;
  }

  RunConfig config_ = MakeConfig();
  PlannerNode planner_{config_, [] { return 0.0; }};
};

TEST_F(PlannerThatIsAsked, LeavesOutDamagedDeltasCountsThemAndGoesOn) {
  ASSERT_TRUE(Ask(0, PlanMode::kFirst).found);
  Tell(MeshDelta{1, 0, false, {}, {{0, {1u << 27, 5, 6}}}});
  Tell(MeshDelta{1, 0, true, {{.id = kMaxSlots - 1}}, {}});
  EXPECT_EQ(CountComplaint("refused_mesh"), 2);
  EXPECT_EQ(planner_.NextInput(), StreamOf<VoxelDelta>());
  const auto beyond = static_cast<uint32_t>(config_.grid.cells());
  Tell(VoxelDelta{1, 0, true, {beyond}, {1}, {100}});
  EXPECT_EQ(CountComplaint("refused_voxels"), 1);
  EXPECT_FALSE(Ask(1, PlanMode::kBoundary).found);
}

TEST_F(PlannerThatIsAsked, SaysThatItsStackIsEmptyWhenNoCandidateIsLeft) {
  EXPECT_FALSE(Ask(0, PlanMode::kFirst).stack_is_empty);
  Tell(MeshDelta{1, 0, true, {}, {}});
  Tell(VoxelDelta{1, 0, true, {}, {}, {}});
  const Plan plan = Ask(1, PlanMode::kBoundary);
  EXPECT_FALSE(plan.found);
  EXPECT_TRUE(plan.stack_is_empty);
  EXPECT_EQ(plan.reason, "the stack is empty");
}

}  // namespace
}  // namespace nbs
