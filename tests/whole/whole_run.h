#pragma once

#include <memory>
#include <ostream>

#include "common/config/run_config.h"
#include "common/geometry/triangle_mesh.h"
#include "services/reporter/reporter_node.h"
#include "tests/whole/network.h"

namespace nbs {

/// What is left of a run in one process.
struct WholeRun {
  RunRecord record;
  MeshReplica mesh;
  VoxelGrid voxels;
};

/// Runs all services on a simulated object in one process, without the bus.
///
/// @param config    Complete but for grid and first_path, which are placed around the object.
/// @param evaluator  Rates the mesh after each scan; empty: none.
/// @param progress  Gets a line per scan; null: none.
/// @param observer  Sees every message.
WholeRun RunWhole(RunConfig config, const TriangleMesh& object_W, const ReporterNode::Evaluator& evaluator,
                  std::ostream* progress, const Network::Observer& observer = {});

}  // namespace nbs
