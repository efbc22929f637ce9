#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/motion_audit.h"

namespace nbs {

/// What was done and seen, scan by scan.
struct RunTraces {
  std::vector<ExecutedMotion> motions;
  std::vector<TriangleMesh> meshes_W;  ///< After each scan.
};

/// The executed motions, and how many robot states could not be used.
struct GroupedMotions {
  std::vector<ExecutedMotion> motions;
  int64_t refused_states = 0;
};

/// Puts together what belongs to one scan: the trajectory sent, the states reported, and whether it was done. States
/// without a trajectory make a motion of their own.
///
/// Of an arm only states with a value for each joint are taken; the others are counted. A motion that lacks some of its
/// states, or whose trajectory has a point with another number of joints, does not count as done: its states alone do.
///
/// @param joints  Of the arm; none for a free-flying sensor, whose states may have any.
GroupedMotions GroupMotions(const std::vector<Trajectory>& trajectories, const std::vector<RobotState>& states,
                            const std::vector<Execution>& executions, std::optional<size_t> joints);

}  // namespace nbs
