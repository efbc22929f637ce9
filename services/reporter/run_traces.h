#pragma once

#include <vector>

#include "sim/motion_audit.h"

namespace nbs {

/// What was done and seen, scan by scan.
struct RunTraces {
  std::vector<ExecutedMotion> motions;
  std::vector<TriangleMesh> meshes_W;  ///< After each scan.
};

/// Puts together what belongs to one scan: the trajectory sent, the states reported, and whether it was done. States
/// without a trajectory make a motion of their own.
std::vector<ExecutedMotion> GroupMotions(const std::vector<Trajectory>& trajectories,
                                         const std::vector<RobotState>& states,
                                         const std::vector<Execution>& executions);

}  // namespace nbs
