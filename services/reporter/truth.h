#pragma once

#include "common/config/run_config.h"
#include "services/reporter/reporter_node.h"

namespace nbs {

/// What rates a mesh of this run: the true object's coverage oracle, made once; an empty function if the run has no
/// truth.
///
/// @throws ConfigError as LoadObject.
ReporterNode::Evaluator MakeEvaluator(const RunConfig& config);

}  // namespace nbs
