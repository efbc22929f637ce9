#include "services/simulator/simulator_node.h"

namespace nbs {
namespace {

/// The object, and after its triangles the table's top as one large square.
TriangleMesh MakeWorld(TriangleMesh world_W, const CellConfig& cell) {
  if (!cell.table_z_m) return world_W;
  constexpr float kHalf_m = 5.0f;
  const auto z = static_cast<float>(*cell.table_z_m);
  const auto first = static_cast<uint32_t>(world_W.vertices_W.size());
  world_W.vertices_W.insert(
      world_W.vertices_W.end(),
      {{-kHalf_m, -kHalf_m, z}, {kHalf_m, -kHalf_m, z}, {kHalf_m, kHalf_m, z}, {-kHalf_m, kHalf_m, z}});
  world_W.triangles.push_back({first, first + 1, first + 2});
  world_W.triangles.push_back({first, first + 2, first + 3});
  return world_W;
}

}  // namespace

SimulatorNode::SimulatorNode(const TriangleMesh& object_W, const RunConfig& config)
    : X_FS_(config.cell.X_FS),
      scene_W_(MakeWorld(object_W, config.cell)),
      profiler_(scene_W_, config.cell.profiler, config.seed, static_cast<uint32_t>(object_W.triangles.size())) {}

void SimulatorNode::Handle(const Message& message, Outbox& out) {
  const RobotState& state = std::get<RobotState>(message);
  if (state.scan != scan_) {
    scan_ = state.scan;
    profiles_in_scan_ = 0;
  }
  Profile profile;
  profile.utime_us = state.utime_us;
  if (state.scanning) {
    profile.ranges_m = profiler_.TakeProfile(state.X_WF * X_FS_, scan_, profiles_in_scan_);
    ++profiles_in_scan_;
    out.push_back(std::move(profile));
  } else if (state.end_of_scan) {
    profile.end_of_scan = true;
    out.push_back(std::move(profile));
  }
}

}  // namespace nbs
