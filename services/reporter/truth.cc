#include "services/reporter/truth.h"

#include <memory>

#include "sim/coverage.h"
#include "sim/load_object.h"

namespace nbs {

ReporterNode::Evaluator MakeEvaluator(const RunConfig& config) {
  if (!HasTruth(config)) return {};
  CoverageSettings settings;
  settings.profiler = config.cell.profiler;
  settings.table_z_m = config.cell.table_z_m;
  const auto oracle = std::make_shared<const CoverageOracle>(LoadObject(config), settings);
  return [oracle](const TriangleMesh& mesh_W) {
    const Coverage rated = oracle->Evaluate(mesh_W);
    return Evaluation{rated.coverage, rated.observable_coverage, rated.rmse_m};
  };
}

}  // namespace nbs
