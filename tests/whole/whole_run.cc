#include "tests/whole/whole_run.h"

#include <chrono>

#include "services/coordinator/coordinator_node.h"
#include "services/mesher/mesher_node.h"
#include "services/planner/planner_node.h"
#include "services/reporter/reporter_node.h"
#include "services/robot/robot_node.h"
#include "services/sensor/sensor_node.h"
#include "services/simulator/simulator_node.h"
#include "services/voxelmap/voxelmap_node.h"

namespace nbs {

WholeRun RunWhole(RunConfig config, const TriangleMesh& object_W, const ReporterNode::Evaluator& evaluator,
                  std::ostream* progress, const Network::Observer& observer) {
  Eigen::AlignedBox3d box_W;
  for (const Eigen::Vector3f& p_W : object_W.vertices_W) box_W.extend(p_W.cast<double>());
  ResolvePlacement(box_W, config);
  const auto clock = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  auto reporter_node = std::make_unique<ReporterNode>(config.grid, evaluator, progress);
  const ReporterNode& reporter = *reporter_node;
  Network network;
  network.Add("coordinator", std::make_unique<CoordinatorNode>(config));
  network.Add("robot", std::make_unique<RobotNode>(config));
  network.Add("simulator", std::make_unique<SimulatorNode>(object_W, config));
  network.Add("sensor", std::make_unique<SensorNode>(config));
  network.Add("mesher", std::make_unique<MesherNode>(config));
  network.Add("voxelmap", std::make_unique<VoxelmapNode>(config));
  network.Add("planner", std::make_unique<PlannerNode>(config, clock));
  network.Add("reporter", std::move(reporter_node));
  network.Run(observer);
  return {reporter.record(), reporter.mesh(), reporter.voxels()};
}

}  // namespace nbs
