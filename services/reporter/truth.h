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

  /// What the truth says about a run that is over. Without a true object there is no remainder, and motions are looked
  /// at for what does not need it.
  ///
  /// @param mesh_W    The last mesh; without triangles there is no remainder.
  Findings Find(const TriangleMesh& mesh_W, std::span<const ExecutedMotion> motions) const;

 private:
  struct Object;
  RunConfig config_;
  std::shared_ptr<const Object> object_;  ///< None: the run has no truth.
};

}  // namespace nbs
