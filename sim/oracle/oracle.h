#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "sim/coverage.h"
#include "sim/oracle/greedy_cover.h"
#include "sim/oracle/scan_paths.h"

namespace nbs {

struct OracleSettings {
  OraclePathSettings paths;
  CoverageSettings coverage;  ///< Samples, and what a partner of a sample is; the profiler is the cell's.
  int threads = 2;
  int max_scans = 100;
};

/// When a sample counts as covered.
enum class CoverMeans : uint8_t {
  kPartner,  ///< It or a partner of it (partners.h) is seen: the definition that reconstructions are rated by.
  kSeen,     ///< It is seen itself: stricter, since a reconstruction reaches no farther than what was seen.
};

/// One greedy choice of scan paths.
struct OracleCurve {
  CoverMeans means = CoverMeans::kPartner;
  CoverRule rule = CoverRule::kScan;
  bool from_first_path = false;       ///< Begins with the cell's first scan path, as every run does.
  std::vector<double> coverage;       ///< After each scan, 0 to 1: share of all samples.
  std::vector<double> path_length_m;  ///< After each scan: the sum of all paths so far.
  std::vector<ScanPath> paths;
};

struct OracleResult {
  size_t paths = 0;          ///< Looked at, without the cell's first.
  double seen_by_any = 0.0;  ///< Share of the samples that at least one path sees: the oracle's ceiling.
  /// By means, start (free, then from the cell's first path) and rule: eight.
  std::vector<OracleCurve> curves;
};

/// When the curve first reached a coverage.
struct OracleReach {
  int scans = 0;
  double path_length_m = 0.0;
};
std::optional<OracleReach> FindReach(const OracleCurve& curve, double coverage);

/// How well scan paths can be chosen by somebody who knows the object: random straight paths (scan_paths.h), what each
/// sees (path_visibility.h), and a greedy choice among them (greedy_cover.h).
///
/// The robot's reach is not looked at. The same configuration and settings give the same result with any number of
/// threads.
///
/// @param object_W  The true object, triangles counter-clockwise seen from outside.
/// @param progress  Called with (paths done, of), from one thread at a time; may be empty.
/// @throws std::invalid_argument if a setting is out of range or the object leaves no room for paths.
OracleResult RunOracle(const TriangleMesh& object_W, const RunConfig& config, const OracleSettings& settings,
                       const std::function<void(size_t, size_t)>& progress);

}  // namespace nbs
