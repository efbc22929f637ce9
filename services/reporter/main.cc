// nbs-reporter: follows a run, a line per scan; with --offline, writes what the run leaves, from its histories.

#include <algorithm>
#include <iostream>
#include <string_view>

#include "common/bus/merge.h"
#include "common/bus/offline.h"
#include "common/bus/service_main.h"
#include "common/bus/status_record.h"
#include "common/runtime/error.h"
#include "services/reporter/outputs.h"
#include "services/reporter/run_traces.h"
#include "services/reporter/truth.h"

namespace {
/// Exit code 0 if the outputs are written, whatever the end of the run; 1 on bad input; 2 otherwise.
int WriteOffline(const std::filesystem::path& run_folder) {
  try {
    const nbs::RunConfig config = nbs::ReadRunConfig(run_folder);
    const nbs::Truth truth(config);
    std::vector<nbs::TriangleMesh> meshes_W;
    nbs::ReporterNode reporter(config.grid, truth.MakeEvaluator(), nullptr,
                               [&meshes_W](const nbs::TriangleMesh& mesh_W) { meshes_W.push_back(mesh_W); });
    nbs::RunOffline(reporter, run_folder);
    nbs::MergeHistories(run_folder / "streams", run_folder / "bus.lcm");
    const auto joints = config.cell.arm ? std::optional(config.cell.arm->start_rad.size()) : std::nullopt;
    const auto [motions, refused_states] =
        nbs::GroupMotions(nbs::ReadAll<nbs::Trajectory>(run_folder), nbs::ReadAll<nbs::RobotState>(run_folder),
                          nbs::ReadAll<nbs::Execution>(run_folder), joints);
    const auto folder = run_folder / "registered";
    const auto registered = nbs::MakeRegisteredModel(
        {nbs::ReadAll<nbs::MeshDelta>(folder), nbs::ReadAll<nbs::MeshScan>(folder), nbs::ReadAll<nbs::Stripe>(folder)},
        nbs::ReadAll<nbs::Stripe>(run_folder), truth.MakeEvaluator());
    nbs::Findings findings = truth.Find((registered ? registered->mesh : reporter.mesh()).MakeCompactMesh(), motions);
    findings.refused_states = refused_states;
    findings.time.mesh_s = nbs::ReadBusyTime(run_folder, "mesher");
    findings.time.map_s = nbs::ReadBusyTime(run_folder, "voxelmap");
    nbs::AddPlanning(reporter.record(), findings.time);
    if (registered) findings.registration = registered->registration;
    nbs::WriteOutputs(config, reporter, registered, findings, {motions, meshes_W});
    if (registered) std::cout << nbs::DescribeRegistration(registered->registration, reporter.record()) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "nbs-reporter: " << error.what() << "\n";
    return dynamic_cast<const nbs::ConfigError*>(&error) != nullptr ? 1 : 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  char** const offline = std::find(argv + 1, argv + argc, std::string_view("--offline"));
  char** const run = std::find(argv + 1, argv + argc, std::string_view("--run"));
  if (offline != argv + argc && argc == 4 && run + 1 < argv + argc) return WriteOffline(run[1]);
  return nbs::RunService("reporter", argc, argv, [](const nbs::RunConfig& config) {
    return std::make_unique<nbs::ReporterNode>(config.grid, nbs::Truth(config).MakeEvaluator(), &std::cout);
  });
}
