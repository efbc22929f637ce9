#include "services/coordinator/coordinator_node.h"

#include <gtest/gtest.h>

#include "common/messages/translate.h"

namespace nbs {
namespace {

// Answers the coordinator's commands like a planner, a robot and a mesher whose mesh gains `gain` in completeness a
// scan.
Outbox RunToTheEnd(double gain) {
  CoordinatorNode node{RunConfig{}};
  Outbox out;
  node.Start(out);
  PlanRequest request;
  double completeness = 0.9;
  int64_t edges = 1000;
  for (int steps = 0; node.NextInput() != Node::kNoInput && steps < 1000; ++steps) {
    for (const Message& message : out) {
      if (const auto* asked = std::get_if<PlanRequest>(&message)) request = *asked;
    }
    const int64_t utime_us = CalcUtime(out.back()) + 10;
    if (node.NextInput() == StreamOf<Plan>()) {
      Plan plan;
      plan.utime_us = utime_us;
      plan.scan = request.scan;
      plan.mode = request.mode;
      plan.found = true;
      node.Handle(plan, out);
    } else if (node.NextInput() == StreamOf<Execution>()) {
      node.Handle(Execution{utime_us, request.scan, true, ""}, out);
    } else {
      MeshScan mesh;
      mesh.utime_us = utime_us;
      mesh.scan = request.scan;
      mesh.completeness = completeness += gain;
      if (request.scan < 4) edges += 1000;  // The surface is seen after four scans.
      mesh.edges = edges;
      node.Handle(mesh, out);
    }
  }
  EXPECT_EQ(node.NextInput(), Node::kNoInput);
  return out;
}

TEST(CoordinatorNode, RunsUntilTheMeshIsComplete) {
  const Outbox out = RunToTheEnd(0.02);
  const auto& last = std::get<RunState>(out.back());
  EXPECT_EQ(last.phase, RunPhase::kFinished);
  EXPECT_EQ(last.end_reason, "completeness_reached");
  EXPECT_EQ(last.scan, 6);
}

TEST(CoordinatorNode, StopsAtTheLimitOnScans) {
  const auto& last = std::get<RunState>(RunToTheEnd(0.0001).back());
  EXPECT_EQ(last.end_reason, "scan_limit");
  EXPECT_EQ(last.scan, RunConfig{}.max_scans);
}

TEST(CoordinatorNode, TimesNeverFall) {
  int64_t latest_us = 0;
  for (const Message& message : RunToTheEnd(0.02)) {
    EXPECT_GE(CalcUtime(message), latest_us);
    latest_us = CalcUtime(message);
  }
}

TEST(CoordinatorNode, EveryScanIsAskedForScannedAndToldOnce) {
  int requests = 0;
  int trajectories = 0;
  int states = 0;
  for (const Message& message : RunToTheEnd(0.02)) {
    requests += std::holds_alternative<PlanRequest>(message);
    trajectories += std::holds_alternative<Trajectory>(message);
    states += std::holds_alternative<RunState>(message);
  }
  EXPECT_EQ(requests, 6);
  EXPECT_EQ(trajectories, 6);
  EXPECT_EQ(states, 2 * 6 + 1);
}

}  // namespace
}  // namespace nbs
