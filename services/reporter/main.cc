// nbs-reporter: follows a run on the bus and prints a line per scan; with --offline, writes what the run leaves from
// the histories in its folder.

#include <algorithm>
#include <iostream>
#include <string_view>

#include "common/bus/merge.h"
#include "common/bus/offline.h"
#include "common/bus/service_main.h"
#include "common/runtime/error.h"
#include "services/reporter/outputs.h"
#include "services/reporter/truth.h"
#include "sim/pose_error.h"

namespace {

/// Where the sensor truly was at all states of the robot.
std::vector<nbs::Pose> ReadSensorPoses(const nbs::RunConfig& config) {
  std::vector<nbs::Pose> poses_WS;
  const nbs::PoseError error = nbs::PoseError::Make(config);
  nbs::StreamReader reader(config.folder, nbs::StreamOf<nbs::RobotState>());
  while (const auto message = reader.Next()) {
    const auto& state = std::get<nbs::RobotState>(*message);
    poses_WS.push_back(error.CalcTruePose(state.X_WF, state.utime_us) * config.cell.X_FS);
  }
  return poses_WS;
}

/// Exit code 0 if the outputs are written, whatever the end of the run; 1 on bad input; 2 otherwise.
int WriteOffline(const std::filesystem::path& run_folder) {
  try {
    const nbs::RunConfig config = nbs::ReadRunConfig(run_folder);
    const nbs::Truth truth(config);
    nbs::ReporterNode reporter(config.grid, truth.MakeEvaluator(), nullptr);
    nbs::RunOffline(reporter, run_folder);
    nbs::MergeHistories(run_folder / "streams", run_folder / "bus.lcm");
    nbs::WriteOutputs(config, reporter, truth.Find(reporter.mesh().MakeCompactMesh(), ReadSensorPoses(config)));
    return 0;
  } catch (const nbs::ConfigError& error) {
    std::cerr << "nbs-reporter: " << error.what() << "\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "nbs-reporter: " << error.what() << "\n";
    return 2;
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
