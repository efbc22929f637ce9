#include "services/reporter/run_traces.h"

#include <algorithm>
#include <map>
#include <set>

namespace nbs {

GroupedMotions GroupMotions(const std::vector<Trajectory>& trajectories, const std::vector<RobotState>& states,
                            const std::vector<Execution>& executions, std::optional<size_t> joints) {
  const auto fits = [&](const auto& at) { return !joints || at.joints_rad.size() == *joints; };
  GroupedMotions grouped;
  std::map<int32_t, ExecutedMotion> by_scan;
  std::set<int32_t> states_alone;
  for (const RobotState& state : states) {
    if (fits(state)) {
      by_scan[state.scan].states.push_back(state);
    } else {
      ++grouped.refused_states;
      states_alone.insert(state.scan);
    }
  }
  for (const Trajectory& trajectory : trajectories) {
    const auto motion = by_scan.find(trajectory.scan);
    if (motion == by_scan.end()) continue;
    motion->second.trajectory = trajectory;
    if (!std::ranges::all_of(trajectory.points, fits)) states_alone.insert(trajectory.scan);
  }
  for (const Execution& execution : executions) {
    const auto motion = by_scan.find(execution.scan);
    if (motion != by_scan.end()) motion->second.done = execution.done && !states_alone.contains(execution.scan);
  }
  for (auto& [scan, motion] : by_scan) {
    motion.trajectory.scan = scan;
    grouped.motions.push_back(std::move(motion));
  }
  return grouped;
}

}  // namespace nbs
