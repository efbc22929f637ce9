#include "common/messages/fingerprint.h"

#include <array>
#include <variant>

#include "common/runtime/node.h"
#include "nbs_msgs/candidate_set_t.hpp"
#include "nbs_msgs/execution_t.hpp"
#include "nbs_msgs/mesh_delta_t.hpp"
#include "nbs_msgs/mesh_scan_t.hpp"
#include "nbs_msgs/plan_request_t.hpp"
#include "nbs_msgs/plan_t.hpp"
#include "nbs_msgs/plan_timing_t.hpp"
#include "nbs_msgs/profile_t.hpp"
#include "nbs_msgs/robot_state_t.hpp"
#include "nbs_msgs/run_state_t.hpp"
#include "nbs_msgs/stripe_t.hpp"
#include "nbs_msgs/trajectory_t.hpp"
#include "nbs_msgs/voxel_delta_t.hpp"

namespace nbs {

uint64_t FindFingerprint(size_t stream) {
  static const auto fingerprints = [] {
    std::array<uint64_t, std::variant_size_v<Message>> table{};
    const auto set = [&](size_t number, int64_t hash) { table.at(number) = static_cast<uint64_t>(hash); };
    set(StreamOf<PlanRequest>(), nbs_msgs::plan_request_t::getHash());
    set(StreamOf<Trajectory>(), nbs_msgs::trajectory_t::getHash());
    set(StreamOf<RunState>(), nbs_msgs::run_state_t::getHash());
    set(StreamOf<RobotState>(), nbs_msgs::robot_state_t::getHash());
    set(StreamOf<Execution>(), nbs_msgs::execution_t::getHash());
    set(StreamOf<Profile>(), nbs_msgs::profile_t::getHash());
    set(StreamOf<Stripe>(), nbs_msgs::stripe_t::getHash());
    set(StreamOf<MeshDelta>(), nbs_msgs::mesh_delta_t::getHash());
    set(StreamOf<MeshScan>(), nbs_msgs::mesh_scan_t::getHash());
    set(StreamOf<VoxelDelta>(), nbs_msgs::voxel_delta_t::getHash());
    set(StreamOf<Plan>(), nbs_msgs::plan_t::getHash());
    set(StreamOf<CandidateSet>(), nbs_msgs::candidate_set_t::getHash());
    set(StreamOf<PlanTiming>(), nbs_msgs::plan_timing_t::getHash());
    return table;
  }();
  return fingerprints.at(stream);
}

}  // namespace nbs
