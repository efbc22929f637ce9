// nbs-pictures: draws the mesh of a run as it was after some of its scans, from the histories in the run folder.

#include <CLI/CLI.hpp>
#include <memory>

#include "common/bus/offline.h"
#include "common/runtime/report_failure.h"
#include "services/reporter/reporter_node.h"
#include "services/reporter/snapshots.h"

namespace {

/// The box that was unknown at the start, which the object fills but for its margin.
Eigen::AlignedBox3d FindFrame(const nbs::RunConfig& config) {
  const Eigen::Vector3d size = config.grid.resolution_m * config.grid.size.cast<double>();
  Eigen::AlignedBox3d box_W(config.grid.origin_W, config.grid.origin_W + size);
  box_W.min().array() += config.cell.unknown_margin_m;
  box_W.max().array() -= config.cell.unknown_margin_m;
  return box_W;
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::path run;
  std::vector<int> after = {5, 15, 30};
  CLI::App app("Draws the mesh of a run after some of its scans: RUN/pictures/after-05-front.png, ….", "nbs-pictures");
  app.add_option("--run", run, "A run folder with its streams")->required();
  app.add_option("--after", after, "Numbers of scans")->check(CLI::PositiveNumber)->capture_default_str();
  try {
    app.parse(argc, argv);
    const nbs::RunConfig config = nbs::ReadRunConfig(run);
    nbs::Snapshots snapshots(run / "pictures", FindFrame(config), {after.begin(), after.end()});
    nbs::ReporterNode reporter(
        config.grid,
        [&snapshots](const nbs::TriangleMesh& mesh_W) {
          snapshots.Add(mesh_W);
          return nbs::Evaluation{};
        },
        nullptr);
    nbs::RunOffline(reporter, run);
    snapshots.Finish();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    return nbs::ReportFailure("nbs-pictures", error);
  }
  return 0;
}
