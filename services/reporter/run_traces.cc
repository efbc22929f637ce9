#include "services/reporter/run_traces.h"

#include <map>

namespace nbs {

std::vector<ExecutedMotion> GroupMotions(const std::vector<Trajectory>& trajectories,
                                         const std::vector<RobotState>& states,
                                         const std::vector<Execution>& executions) {
  std::map<int32_t, ExecutedMotion> by_scan;
  for (const RobotState& state : states) by_scan[state.scan].states.push_back(state);
  for (const Trajectory& trajectory : trajectories) {
    const auto motion = by_scan.find(trajectory.scan);
    if (motion != by_scan.end()) motion->second.trajectory = trajectory;
  }
  for (const Execution& execution : executions) {
    const auto motion = by_scan.find(execution.scan);
    if (motion != by_scan.end()) motion->second.done = execution.done;
  }
  std::vector<ExecutedMotion> motions;
  for (auto& [scan, motion] : by_scan) {
    motion.trajectory.scan = scan;
    motions.push_back(std::move(motion));
  }
  return motions;
}

}  // namespace nbs
