#include "services/reporter/truth.h"

#include "sim/coverage.h"
#include "sim/load_object.h"
#include "sim/rigid_fit.h"

namespace nbs {
namespace {

CoverageSettings MakeCoverageSettings(const CellConfig& cell) {
  CoverageSettings settings;
  settings.profiler = cell.profiler;
  settings.table_z_m = cell.table_z_m;
  return settings;
}

Evaluation Rate(const CoverageOracle& oracle, const TriangleMesh& mesh_W) {
  const Coverage rated = oracle.Evaluate(mesh_W);
  return {rated.coverage, rated.observable_coverage, rated.rmse_m};
}

Shape RateShape(const CoverageOracle& oracle, const TriangleMesh& mesh_W) {
  const Pose X_WM = FitRigid(mesh_W, oracle.truth_W());
  const Eigen::Vector3d middle_W = oracle.truth_W().box_W().center();
  return {Rate(oracle, MoveMesh(mesh_W, X_WM)), (X_WM * middle_W - middle_W).norm(),
          CalcAngleBetween(X_WM, Pose::Identity())};
}

}  // namespace

struct Truth::Object {
  Object(TriangleMesh mesh, const CellConfig& cell)
      : mesh_W(std::move(mesh)), oracle(mesh_W, MakeCoverageSettings(cell)) {}

  TriangleMesh mesh_W;
  CoverageOracle oracle;
};

Truth::Truth(const RunConfig& config) : config_(config) {
  if (HasTruth(config)) object_ = std::make_shared<const Object>(LoadObject(config), config.cell);
}

Truth::~Truth() = default;

ReporterNode::Evaluator Truth::MakeEvaluator() const {
  if (!object_) return {};
  return [object = object_](const TriangleMesh& mesh_W) { return Rate(object->oracle, mesh_W); };
}

Findings Truth::Find(const TriangleMesh& mesh_W, std::span<const ExecutedMotion> motions) const {
  Findings findings;
  MotionAuditor auditor(object_ ? object_->mesh_W : TriangleMesh{}, config_);
  for (const ExecutedMotion& motion : motions) auditor.Look(motion);
  findings.motion = auditor.audit();
  findings.time.motion_s = auditor.audit().move_s;
  findings.time.scan_s = auditor.audit().scan_s;
  if (!object_ || mesh_W.triangles.empty()) return findings;
  if (config_.cell.arm) findings.shape = RateShape(object_->oracle, mesh_W);
  RemainderSettings settings;
  settings.profiler = config_.cell.profiler;
  settings.table_z_m = config_.cell.table_z_m;
  settings.body_S = config_.cell.sensor_body_S;
  settings.body_margin_m = config_.cell.body_margin_m;
  findings.remainder = RemainderExplainer(object_->mesh_W, object_->oracle, settings).Explain(mesh_W);
  return findings;
}

}  // namespace nbs
