#pragma once

#include <functional>
#include <optional>
#include <ostream>

#include "common/geometry/mesh_delta.h"
#include "common/mapping/voxel_grid.h"
#include "common/runtime/node.h"
#include "services/reporter/run_record.h"

namespace nbs {

/// Follows a run: keeps replicas of mesh and voxel space, has each scan's mesh evaluated, and writes a line per scan.
///
/// Reads a RunState first. One that says "planning" is followed by that round's candidates, plan and timing; one that
/// says "scanning" by execution, mesh, voxels and figures of that scan; after "finished" nothing is read any more.
class ReporterNode : public Node {
 public:
  /// Rates a mesh against the truth; empty when no truth is known.
  using Evaluator = std::function<Evaluation(const TriangleMesh& mesh_W)>;

  /// Sees the mesh after each scan.
  using Observer = std::function<void(const TriangleMesh& mesh_W)>;

  /// @param progress  Gets a line per scan; null: none. Must outlive the node.
  ReporterNode(const GridShape& grid, Evaluator evaluator, std::ostream* progress, Observer observer = {});

  size_t NextInput() const override { return next_input_; }
  void Handle(const Message& message, Outbox& out) override;

  /// Damaged deltas of mesh and voxels; they are left out.
  std::vector<Count> Complaints() const override;

  const RunRecord& record() const { return record_; }
  const MeshReplica& mesh() const { return mesh_; }
  const VoxelGrid& voxels() const { return voxels_; }

 private:
  void Fold(const RunState& state);
  void Fold(const CandidateSet& set);
  void Fold(const Plan& plan);
  void Fold(const PlanTiming& timing);
  void Fold(const Execution& execution);
  void Fold(const MeshDelta& delta);
  void Fold(const VoxelDelta& delta);
  void Fold(const MeshScan& figures);

  Evaluator evaluator_;
  Observer observer_;
  std::ostream* progress_;
  size_t next_input_;
  MeshReplica mesh_;
  VoxelGrid voxels_;
  int64_t refused_mesh_ = 0;
  int64_t refused_voxels_ = 0;
  RunRecord record_;
  ScanRecord current_;  ///< The scan under way, with the selection that led to it.
};

}  // namespace nbs
