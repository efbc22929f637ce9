#include "sim/oracle/oracle.h"

#include <mutex>
#include <stdexcept>

#include "common/runtime/parallel.h"
#include "sim/oracle/partners.h"
#include "sim/oracle/path_visibility.h"

namespace nbs {
namespace {

/// The samples that each path sees; the paths are shared out among the threads.
CoverTable MakeSeenTable(const PathVisibility& visibility, const std::vector<ScanPath>& paths, size_t samples,
                         int threads, const std::function<void(size_t, size_t)>& progress) {
  CoverTable table(paths.size(), samples);
  std::mutex mutex;
  size_t done = 0;
  ForEachIndex(paths.size(), threads, [&](size_t row) {
    for (uint32_t sample : visibility.FindSeen(paths[row])) table.Mark(row, sample);
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(done, paths.size());
  });
  return table;
}

/// The samples of `seen` and their partners.
CoverTable AddPartners(const CoverTable& seen, const Partners& partners) {
  CoverTable table = seen;
  for (size_t path = 0; path < seen.paths(); ++path) {
    for (size_t sample = 0; sample < seen.samples(); ++sample) {
      if (!seen.covers(path, sample)) continue;
      for (uint32_t partner : partners.of(sample)) table.Mark(path, partner);
    }
  }
  return table;
}

OracleCurve MakeCurve(const CoverTable& table, const std::vector<ScanPath>& paths, const CoverSettings& settings) {
  std::vector<double> lengths_m;
  for (const ScanPath& path : paths) lengths_m.push_back(path.length_m());
  OracleCurve curve;
  curve.rule = settings.rule;
  curve.from_first_path = settings.first.has_value();
  double length_m = 0.0;
  for (const CoverStep& step : FindGreedyCover(table, lengths_m, settings)) {
    length_m += lengths_m[step.path];
    curve.coverage.push_back(static_cast<double>(step.covered) / static_cast<double>(table.samples()));
    curve.path_length_m.push_back(length_m);
    curve.paths.push_back(paths[step.path]);
  }
  return curve;
}

/// The last of the paths is the cell's first.
void AppendCurves(const CoverTable& table, CoverMeans means, const std::vector<ScanPath>& paths, int max_scans,
                  std::vector<OracleCurve>& curves) {
  for (const bool from_first : {false, true}) {
    for (const CoverRule rule : {CoverRule::kScan, CoverRule::kMetre}) {
      CoverSettings settings;
      settings.rule = rule;
      settings.max_paths = max_scans;
      if (from_first) settings.first = paths.size() - 1;
      curves.push_back(MakeCurve(table, paths, settings));
      curves.back().means = means;
    }
  }
}

}  // namespace

std::optional<OracleReach> FindReach(const OracleCurve& curve, double coverage) {
  for (size_t i = 0; i < curve.coverage.size(); ++i) {
    if (curve.coverage[i] >= coverage) return OracleReach{static_cast<int>(i) + 1, curve.path_length_m[i]};
  }
  return std::nullopt;
}

OracleResult RunOracle(const TriangleMesh& object_W, const RunConfig& config, const OracleSettings& settings,
                       const std::function<void(size_t, size_t)>& progress) {
  if (settings.threads < 1 || settings.paths.count < 1) {
    throw std::invalid_argument("RunOracle: needs at least one thread and one path");
  }
  const TriangleScene scene_W(object_W);
  const std::vector<SurfaceSample> samples = MakeSurfaceSamples(object_W, settings.coverage.samples);
  const OracleBody body{config.cell.sensor_body_S, config.cell.table_z_m};
  std::vector<ScanPath> paths = MakeRandomScanPaths(scene_W, samples, body, settings.paths);
  paths.push_back(config.first_path);
  const PathVisibility visibility(scene_W, samples, config.cell.profiler);
  const CoverTable seen = MakeSeenTable(visibility, paths, samples.size(), settings.threads, progress);
  OracleResult result;
  result.paths = paths.size() - 1;
  result.seen_by_any = static_cast<double>(seen.CountCovered()) / static_cast<double>(samples.size());
  const Partners partners(samples, settings.coverage.max_distance_m, settings.coverage.max_angle_rad);
  AppendCurves(AddPartners(seen, partners), CoverMeans::kPartner, paths, settings.max_scans, result.curves);
  AppendCurves(seen, CoverMeans::kSeen, paths, settings.max_scans, result.curves);
  return result;
}

}  // namespace nbs
