#pragma once

#include <memory>
#include <span>

#include "common/config/run_config.h"
#include "services/reporter/reporter_node.h"

namespace nbs {

/// The true object of a run, and what it says about the run.
class Truth {
 public:
  /// @throws ConfigError as LoadObject, if the run has a true object that cannot be read.
  explicit Truth(const RunConfig& config);
  ~Truth();

  /// Rates a mesh; an empty function if the run has no truth. May outlive this.
  ReporterNode::Evaluator MakeEvaluator() const;

  /// @param mesh_W    The last mesh; without triangles there is no remainder.
  /// @param poses_WS  Where the sensor truly was, at every state of the robot.
  Findings Find(const TriangleMesh& mesh_W, std::span<const Pose> poses_WS) const;

 private:
  struct Object;
  CellConfig cell_;
  std::shared_ptr<const Object> object_;  ///< None: the run has no truth.
};

}  // namespace nbs
