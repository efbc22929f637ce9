#include "services/simulator/simulator_node.h"

namespace nbs {
namespace {

/// The object, and after its triangles the table's top.
TriangleMesh MakeWorld(TriangleMesh world_W, const RunConfig& config) {
  if (!config.cell.table_z_m) return world_W;
  const auto z = static_cast<float>(*config.cell.table_z_m);
  const Eigen::Vector2f half = config.cell.table_half_m.cast<float>();
  const Eigen::Vector2f middle = config.p_WO.head<2>().cast<float>();
  const auto first = static_cast<uint32_t>(world_W.vertices_W.size());
  const auto corner = [&](float x, float y) {
    world_W.vertices_W.emplace_back(middle.x() + x * half.x(), middle.y() + y * half.y(), z);
  };
  corner(-1, -1);
  corner(1, -1);
  corner(1, 1);
  corner(-1, 1);
  world_W.triangles.push_back({first, first + 1, first + 2});
  world_W.triangles.push_back({first, first + 2, first + 3});
  return world_W;
}

}  // namespace

SimulatorNode::SimulatorNode(const TriangleMesh& object_W, const RunConfig& config)
    : X_FS_(config.cell.X_FS),
      pose_error_(PoseError::Make(config)),
      scene_W_(MakeWorld(object_W, config)),
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
    profile.ranges_m =
        profiler_.TakeProfile(pose_error_.CalcTruePose(state.X_WF, state.utime_us) * X_FS_, scan_, profiles_in_scan_);
    ++profiles_in_scan_;
    out.push_back(std::move(profile));
  } else if (state.end_of_scan) {
    profile.end_of_scan = true;
    out.push_back(std::move(profile));
  }
}

}  // namespace nbs
