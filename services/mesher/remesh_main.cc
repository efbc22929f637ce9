// nbs-remesh: registers the scans of a run that is over with each other, where its cell asks for that, and meshes their
// stripes anew. RUN/registered/streams then has the moved stripes, one MeshDelta and one MeshScan.

#include <CLI/CLI.hpp>

#include "common/bus/offline.h"
#include "common/bus/recorder.h"
#include "common/config/run_config.h"
#include "common/runtime/report_failure.h"
#include "services/mesher/remesh.h"

namespace {

namespace fs = std::filesystem;

bool AsksForRegistration(const nbs::CellConfig& cell) { return cell.arm && cell.arm->registration == "joint"; }

/// Appears whole or not at all.
void WriteRegistered(const nbs::RunConfig& config, const fs::path& run, nbs::Registered registered) {
  const fs::path temporary = run / "registered.tmp";
  fs::remove_all(temporary);
  nbs::Recorder("sensor", config.run_id, temporary).Record(std::move(registered.stripes));
  nbs::Recorder("mesher", config.run_id, temporary).Record(std::move(registered.mesh));
  fs::rename(temporary, run / "registered");
}

}  // namespace

int main(int argc, char** argv) {
  fs::path run;
  CLI::App app("Registers the scans of a run with each other and meshes them anew: RUN/registered.", "nbs-remesh");
  app.add_option("--run", run, "A run folder with its streams")->required();
  try {
    app.parse(argc, argv);
    const nbs::RunConfig config = nbs::ReadRunConfig(run);
    fs::remove_all(run / "registered");
    if (!AsksForRegistration(config.cell)) return 0;
    std::vector<nbs::Stripe> stripes = nbs::ReadAll<nbs::Stripe>(run);
    if (!stripes.empty()) WriteRegistered(config, run, nbs::Remesh(config.cell.profiler, std::move(stripes)));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    return nbs::ReportFailure("nbs-remesh", error);
  }
  return 0;
}
