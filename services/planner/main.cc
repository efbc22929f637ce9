// nbs-planner: answers plan requests with the next best scan.

#include <chrono>

#include "common/bus/service_main.h"
#include "services/planner/planner_node.h"

int main(int argc, char** argv) {
  const auto clock = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  return nbs::RunService("planner", argc, argv, [&](const nbs::RunConfig& config) {
    return std::make_unique<nbs::PlannerNode>(config, clock);
  });
}
