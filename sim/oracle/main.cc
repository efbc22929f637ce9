// nbs-oracle: how well the scan paths of a run could be chosen by somebody who knows the object.

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "common/runtime/error.h"
#include "common/runtime/report_failure.h"
#include "sim/load_object.h"
#include "sim/oracle/oracle_json.h"

namespace {

void ShowProgress(size_t done, size_t all) {
  if (done * 10 / all != (done - 1) * 10 / all) std::cerr << "oracle: " << done << " of " << all << " paths\n";
}

void Write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw nbs::ConfigError(file.string() + ": cannot be written: is the disk full, or the folder read-only?");
  std::filesystem::rename(temporary, file);
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::path run, out;
  nbs::OracleSettings settings;
  CLI::App app("A planner that knows the truth: how few scans, how short a path. Writes JSON.", "nbs-oracle");
  app.add_option("--run", run, "A run folder (nbs-prepare makes one): its object and cell are taken")->required();
  app.add_option("--paths", settings.paths.count, "Random scan paths to choose from")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", settings.paths.seed, "Seed of the paths")->capture_default_str();
  app.add_option("--samples", settings.coverage.samples, "Points of the surface")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--partner-distance-m", settings.coverage.max_distance_m, "Covered so far beside what is seen")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", settings.threads)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--max-scans", settings.max_scans)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--out", out, "The result (default: RUN/oracle.json)");
  try {
    app.parse(argc, argv);
    const nbs::RunConfig config = nbs::ReadRunConfig(run);
    const nbs::OracleResult result = nbs::RunOracle(nbs::LoadObject(config), config, settings, ShowProgress);
    Write(out.empty() ? run / "oracle.json" : out, nbs::MakeOracleJson(config, settings, result));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    return nbs::ReportFailure("nbs-oracle", error);
  }
  return 0;
}
