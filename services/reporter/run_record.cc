#include "services/reporter/run_record.h"

#include <algorithm>

namespace nbs {

double CalcPathLength(const RunRecord& record) {
  double length_m = 0.0;
  for (const ScanRecord& scan : record.scans) length_m += scan.path.length_m();
  return length_m;
}

void AddPlanning(const RunRecord& record, TimeSplit& split) {
  const auto add = [&split](const PlanTiming& timing) {
    split.selection_s += timing.update_s + timing.candidates_s + timing.gain_s;
    split.planning_s += timing.motion_s;
  };
  for (const ScanRecord& scan : record.scans) add(scan.timing);
  add(record.last_timing);
}

std::vector<double> CollectPlanTimes(const RunRecord& record) {
  std::vector<double> times_s = record.last_timing.plans_s;
  for (const ScanRecord& scan : record.scans)
    times_s.insert(times_s.end(), scan.timing.plans_s.begin(), scan.timing.plans_s.end());
  std::ranges::sort(times_s);
  return times_s;
}

std::optional<double> CalcMeanSelection(const RunRecord& record) {
  double sum_s = 0.0;
  int count = 0;
  for (const ScanRecord& scan : record.scans) {
    if (scan.mode == PlanMode::kFirst) continue;
    sum_s += scan.timing.total_s;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum_s / count;
}

bool HasFailed(const RunRecord& record) { return record.failed || record.end_reason == kInterrupted; }

std::optional<FinalMesh> FindStreamedMesh(const RunRecord& record) {
  if (record.scans.empty()) return std::nullopt;
  const ScanRecord& last = record.scans.back();
  return FinalMesh{last.completeness, last.rim_length_m, last.triangles, last.evaluation};
}

std::optional<FinalMesh> FindFinalMesh(const RunRecord& record, const Findings& findings) {
  if (!findings.registration) return FindStreamedMesh(record);
  const MeshScan& figures = findings.registration->figures;
  return FinalMesh{figures.completeness, figures.rim_length_m, figures.triangles, findings.registration->evaluation};
}

}  // namespace nbs
