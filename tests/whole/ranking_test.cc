// The stack is ranked by a part of the beams; what is chosen must be what all beams would choose. Over a real run.

#include <gtest/gtest.h>

#include <array>
#include <deque>

#include "services/planner/planner_node.h"
#include "tests/whole/small_object.h"
#include "tests/whole/whole_run.h"

namespace nbs {
namespace {

RunConfig MakeConfig() {
  RunConfig config;
  config.cell = ReadCellConfig(NBS_SOURCE_DIR "/sim/cells/free.yaml");
  config.gain = ToString(GainRule::kSum);
  config.max_scans = 8;
  config.completeness = 1.0;
  return config;
}

struct Recording {
  std::array<std::deque<Message>, std::variant_size_v<Message>> by_stream;
  std::vector<Plan> plans;
};

Recording Record(const RunConfig& config) {
  Recording recording;
  (void)RunWhole(config, MakeSmallObject(), {}, nullptr, [&](const Message& message) {
    recording.by_stream.at(message.index()).push_back(message);
    if (const auto* plan = std::get_if<Plan>(&message)) recording.plans.push_back(*plan);
  });
  return recording;
}

/// What a planner answers to what another one was told.
std::vector<Plan> Answer(PlannerNode& planner, Recording recording) {
  std::vector<Plan> plans;
  for (;;) {
    std::deque<Message>& input = recording.by_stream.at(planner.NextInput());
    if (input.empty()) return plans;
    Outbox out;
    planner.Handle(input.front(), out);
    input.pop_front();
    for (const Message& message : out) {
      if (const auto* plan = std::get_if<Plan>(&message)) plans.push_back(*plan);
    }
  }
}

TEST(Ranking, APartOfTheBeamsChoosesWhatAllBeamsChoose) {
  RunConfig config = MakeConfig();
  Eigen::AlignedBox3d box_W;
  for (const Eigen::Vector3f& p_W : MakeSmallObject().vertices_W) box_W.extend(p_W.cast<double>());
  ResolvePlacement(box_W, config);
  const Recording recording = Record(config);
  ASSERT_GE(recording.plans.size(), 6u);

  PlannerSettings in_full;
  in_full.ranking = kAllBeams;
  PlannerNode planner(
      config, [] { return 0.0; }, in_full);
  const std::vector<Plan> plans = Answer(planner, recording);
  ASSERT_EQ(plans.size(), recording.plans.size());
  for (size_t i = 0; i < plans.size(); ++i) {
    EXPECT_EQ(plans[i].chosen.candidate.id, recording.plans[i].chosen.candidate.id) << "scan " << i;
    EXPECT_EQ(plans[i].chosen.gain_nat, recording.plans[i].chosen.gain_nat) << "scan " << i;
  }
}

}  // namespace
}  // namespace nbs
