#include "common/messages/wiring.h"

namespace nbs {

std::span<const StreamWiring> Wiring() {
  static const std::vector<StreamWiring> wiring = {
      {StreamOf<PlanRequest>(), "PLAN_REQUEST", "plan_request_t", "coordinator", {"planner"}},
      {StreamOf<Trajectory>(), "TRAJECTORY", "trajectory_t", "coordinator", {"robot"}},
      {StreamOf<RunState>(), "RUN_STATE", "run_state_t", "coordinator", {"reporter"}},
      {StreamOf<RobotState>(), "ROBOT_STATE", "robot_state_t", "robot", {"simulator", "sensor"}},
      {StreamOf<Execution>(), "EXECUTION", "execution_t", "robot", {"coordinator", "reporter"}},
      {StreamOf<Profile>(), "PROFILE", "profile_t", "simulator", {"sensor"}},
      {StreamOf<Stripe>(), "STRIPE", "stripe_t", "sensor", {"mesher", "voxelmap"}},
      {StreamOf<MeshDelta>(), "MESH", "mesh_delta_t", "mesher", {"planner", "reporter"}},
      {StreamOf<MeshScan>(), "MESH_SCAN", "mesh_scan_t", "mesher", {"coordinator", "reporter"}},
      {StreamOf<VoxelDelta>(), "VOXELS", "voxel_delta_t", "voxelmap", {"planner", "reporter"}},
      {StreamOf<Plan>(), "PLAN", "plan_t", "planner", {"coordinator", "reporter"}},
      {StreamOf<CandidateSet>(), "CANDIDATES", "candidate_set_t", "planner", {"reporter"}},
      {StreamOf<PlanTiming>(), "PLAN_TIMING", "plan_timing_t", "planner", {"reporter"}},
  };
  return wiring;
}

}  // namespace nbs
