// nbs-reporter: follows a run, a line per scan; with --offline, writes what the run leaves, from its histories.

#include <iostream>

#include "common/bus/merge.h"
#include "common/bus/offline.h"
#include "common/bus/service_main.h"
#include "common/bus/status_record.h"
#include "services/reporter/outputs.h"
#include "services/reporter/run_traces.h"
#include "services/reporter/truth.h"

namespace {
/// Writes the outputs, whatever the end of the run.
void WriteOffline(const std::filesystem::path& run_folder) {
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
}

}  // namespace

int main(int argc, char** argv) {
  const auto make_node = [](const nbs::RunConfig& config) {
    return std::make_unique<nbs::ReporterNode>(config.grid, nbs::Truth(config).MakeEvaluator(), &std::cout);
  };
  return nbs::RunService("reporter", argc, argv, make_node, WriteOffline);
}
