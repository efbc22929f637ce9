#include "sim/oracle/oracle_json.h"

#include <nlohmann/json.hpp>

namespace nbs {
namespace {

using nlohmann::ordered_json;

constexpr double kReached[] = {0.95, 0.98, 0.99, 0.999};
constexpr const char* kReachedNames[] = {"95", "98", "99", "99.9"};

ordered_json MakeJson(const OracleCurve& curve) {
  ordered_json json;
  json["covered"] = curve.means == CoverMeans::kPartner ? "partner" : "seen";
  json["rule"] = curve.rule == CoverRule::kScan ? "scan" : "metre";
  json["start"] = curve.from_first_path ? "first_path" : "free";
  ordered_json reached = ordered_json::object();
  for (size_t i = 0; i < std::size(kReached); ++i) {
    const auto reach = FindReach(curve, kReached[i]);
    reached[kReachedNames[i]] = nullptr;
    if (reach) reached[kReachedNames[i]] = {{"scans", reach->scans}, {"path_length_m", reach->path_length_m}};
  }
  json["reached"] = reached;
  json["coverage"] = curve.coverage;
  json["path_length_m"] = curve.path_length_m;
  return json;
}

}  // namespace

std::string MakeOracleJson(const RunConfig& config, const OracleSettings& settings, const OracleResult& result) {
  ordered_json json;
  json["object"] = config.object;
  json["cell"] = config.cell.name;
  json["paths"] = result.paths;
  json["seed"] = settings.paths.seed;
  json["samples"] = settings.coverage.samples;
  json["partner_distance_m"] = settings.coverage.max_distance_m;
  json["clearance_m"] = settings.paths.clearance_m;
  json["fan_rad"] = config.cell.profiler.fan_rad;
  json["seen_by_any"] = result.seen_by_any;
  json["curves"] = ordered_json::array();
  for (const OracleCurve& curve : result.curves) json["curves"].push_back(MakeJson(curve));
  return json.dump(2) + "\n";
}

}  // namespace nbs
