#include "services/reporter/report_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/planning/method.h"

namespace nbs {
namespace {

using nlohmann::ordered_json;

template <typename T>
ordered_json OrNull(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json MakeVerdicts(const std::array<int, kVerdicts>& counts) {
  ordered_json verdicts = ordered_json::object();
  for (int v = 0; v < kVerdicts; ++v) verdicts[std::string(ToString(static_cast<Verdict>(v)))] = counts[v];
  return verdicts;
}

ordered_json MakeByKind(const std::array<double, kMissingKinds>& values) {
  ordered_json json = ordered_json::object();
  for (int kind = 0; kind < kMissingKinds; ++kind)
    json[std::string(ToString(static_cast<Missing>(kind)))] = values[kind];
  return json;
}

ordered_json MakeMissing(const Remainder& remainder) { return MakeByKind(remainder.missing); }

ordered_json MakeRims(const Remainder& remainder) {
  ordered_json json = MakeByKind(remainder.rim_m);
  json["seam"] = remainder.seam_m;
  return json;
}

ordered_json MakePlace(const std::optional<MotionPlace>& place) {
  if (!place) return nullptr;
  return {{"scan", place->scan}, {"time_s", 1e-6 * static_cast<double>(place->utime_us)}, {"body", place->body}};
}

ordered_json MakeMotionFaults(const MotionAudit& audit) {
  ordered_json json = ordered_json::object();
  for (int k = 0; k < kMotionFaults; ++k) {
    const MotionFaultCount& fault = audit.faults[static_cast<size_t>(k)];
    json[std::string(ToString(static_cast<MotionFault>(k)))] = {{"count", fault.count},
                                                                {"first", MakePlace(fault.first)}};
  }
  return json;
}

ordered_json MakeTimeSplit(const TimeSplit& time) {
  return {{"motion", time.motion_s},     {"scan", time.scan_s},           {"map", OrNull(time.map_s)},
          {"mesh", OrNull(time.mesh_s)}, {"selection", time.selection_s}, {"planning", time.planning_s}};
}

ordered_json MakeScan(const ScanRecord& scan) {
  const bool selected = scan.mode != PlanMode::kFirst;
  ordered_json json;
  json["scan"] = scan.scan;
  json["source"] = ToString(scan.source);
  json["gain"] = scan.by_gain() ? ordered_json(scan.gain_nat) : ordered_json(nullptr);
  json["path_length_m"] = scan.path.length_m();
  json["stripes"] = scan.stripes;
  json["points"] = scan.points;
  json["selection_s"] = selected ? ordered_json(scan.timing.total_s) : ordered_json(nullptr);
  json["selection_split_s"] = {{"update", scan.timing.update_s},
                               {"candidates", scan.timing.candidates_s},
                               {"gain", scan.timing.gain_s},
                               {"motion", scan.timing.motion_s}};
  json["completeness"] = scan.completeness;
  json["rim_length_m"] = scan.rim_length_m;
  json["triangles"] = scan.triangles;
  json["edges"] = scan.edges;
  json["coverage"] = scan.evaluation ? ordered_json(scan.evaluation->coverage) : ordered_json(nullptr);
  json["robot_time_s"] = 1e-6 * static_cast<double>(scan.scanned_utime_us);
  json["candidates"] = scan.candidates;
  json["verdicts"] = MakeVerdicts(scan.verdicts);
  return json;
}

/// Count and quantiles (nearest rank) of the motion plans.
ordered_json MakeMotionPlans(const std::vector<double>& times_s) {
  if (times_s.empty()) return nullptr;
  const auto quantile_ms = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(times_s.size()));
    return 1e3 * times_s.at(static_cast<size_t>(std::max(rank, 1.0)) - 1);
  };
  return {{"count", times_s.size()}, {"median_ms", quantile_ms(0.5)}, {"p95_ms", quantile_ms(0.95)}};
}

/// The figures of a mesh, keys as at the top of the report.
void AddMesh(const std::optional<FinalMesh>& mesh, ordered_json& json) {
  const Evaluation* evaluation = mesh && mesh->evaluation ? &*mesh->evaluation : nullptr;
  json["completeness"] = mesh ? ordered_json(mesh->completeness) : ordered_json(nullptr);
  json["coverage"] = evaluation ? ordered_json(evaluation->coverage) : ordered_json(nullptr);
  json["observable_coverage"] = evaluation ? ordered_json(evaluation->observable_coverage) : ordered_json(nullptr);
  json["rmse_mm"] = evaluation ? ordered_json(1e3 * evaluation->rmse_m) : ordered_json(nullptr);
  json["rim_length_m"] = mesh ? ordered_json(mesh->rim_length_m) : ordered_json(nullptr);
  json["triangles"] = mesh ? ordered_json(mesh->triangles) : ordered_json(nullptr);
}

ordered_json MakeRegistration(const RunRecord& record, const Findings& findings) {
  if (!findings.registration) return nullptr;
  ordered_json json;
  json["mean_correction_mm"] = 1e3 * findings.registration->mean_correction_m;
  json["largest_correction_mm"] = 1e3 * findings.registration->largest_correction_m;
  AddMesh(FindStreamedMesh(record), json["as_streamed"]);
  return json;
}

ordered_json MakeShape(const std::optional<Shape>& shape) {
  if (!shape) return nullptr;
  return {{"moved_mm", 1e3 * shape->moved_m},
          {"turned_mrad", 1e3 * shape->turned_rad},
          {"coverage", shape->evaluation.coverage},
          {"observable_coverage", shape->evaluation.observable_coverage},
          {"rmse_mm", 1e3 * shape->evaluation.rmse_m}};
}

}  // namespace

std::string MakeReportJson(const RunConfig& config, const RunRecord& record, const Findings& findings, double wall_s) {
  ordered_json json;
  json["method"] = config.method;
  json["gain_rule"] = FindMethod(config.method).by_gain ? ordered_json(config.gain) : ordered_json(nullptr);
  json["object"] = config.object.empty() ? ordered_json(nullptr) : ordered_json(config.object);
  json["cell"] = config.cell.name;
  json["seed"] = config.seed;
  json["version"] = config.version;
  json["end_reason"] = record.end_reason;
  json["end_detail"] = record.detail;
  json["failed"] = HasFailed(record);
  json["n_scans"] = record.scans.size();
  json["path_length_m"] = CalcPathLength(record);
  json["mean_selection_s"] = OrNull(CalcMeanSelection(record));
  json["motion_plans"] = MakeMotionPlans(CollectPlanTimes(record));
  AddMesh(FindFinalMesh(record, findings), json);
  json["registration"] = MakeRegistration(record, findings);
  json["shape"] = MakeShape(findings.shape);
  json["wall_s"] = wall_s;
  json["refused_measurements"] = record.refused_measurements;
  json["refused_states"] = findings.refused_states;
  json["robot_time_s"] =
      findings.motion ? ordered_json(findings.time.motion_s + findings.time.scan_s) : ordered_json(nullptr);
  json["time_split_s"] = MakeTimeSplit(findings.time);
  json["states"] = findings.motion ? ordered_json(findings.motion->states) : ordered_json(nullptr);
  json["contacts"] = findings.motion ? ordered_json(findings.motion->contacts) : ordered_json(nullptr);
  json["nearest_mm"] = findings.motion && findings.motion->nearest ? ordered_json(1e3 * findings.motion->nearest_m)
                                                                   : ordered_json(nullptr);
  json["motion_faults"] = findings.motion ? MakeMotionFaults(*findings.motion) : ordered_json(nullptr);
  json["rims_m"] = findings.remainder ? MakeRims(*findings.remainder) : ordered_json(nullptr);
  json["missing"] = findings.remainder ? MakeMissing(*findings.remainder) : ordered_json(nullptr);
  json["last_verdicts"] = MakeVerdicts(record.last_verdicts);
  json["scans"] = ordered_json::array();
  for (const ScanRecord& scan : record.scans) json["scans"].push_back(MakeScan(scan));
  return json.dump(2) + "\n";
}

}  // namespace nbs
