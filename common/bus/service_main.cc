#include "common/bus/service_main.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <optional>

#include "common/bus/lcm_transport.h"
#include "common/bus/lossy_transport.h"
#include "common/bus/service_runner.h"
#include "common/bus/stop_signal.h"
#include "common/runtime/report_failure.h"

namespace nbs {
namespace {

struct ServiceOptions {
  std::filesystem::path run_folder;
  std::string lcm_url;
  std::vector<std::string> without;
  bool exit_when_finished = false;
  bool check = false;
  bool offline = false;
  double drop = 0.0;
  uint64_t drop_seed = 1;
};

/// Reads the command line; returns an exit code if the process is to end here.
std::optional<int> ReadOptions(const std::string& service, int argc, char** argv, bool can_offline,
                               ServiceOptions& options) {
  CLI::App app{"nbs-" + service + ": one service of a next-best-scan run. See services/" + service + "/README.md."};
  app.add_option("--run", options.run_folder, "Run folder; run.yaml in it tells what to do")->required();
  app.add_option("--lcm-url", options.lcm_url, "Bus to join (default: LCM_DEFAULT_URL)");
  app.add_option("--without", options.without,
                 "Services that do not take part, separated by commas: their credit is not waited for")
      ->delimiter(',');
  app.add_flag("--exit-when-finished", options.exit_when_finished,
               "End once all is done, instead of serving repair until stopped");
  app.add_flag("--check", options.check, "Only check that the run can begin, and end");
  if (can_offline)
    app.add_flag("--offline", options.offline, "Write what the run leaves, from the histories in its folder, and end");
  app.add_option("--drop", options.drop, "Test only: share of datagrams to lose, 0 to 1")->check(CLI::Range(0.0, 1.0));
  app.add_option("--drop-seed", options.drop_seed, "Test only: which datagrams are lost");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  }
  return std::nullopt;
}

std::unique_ptr<Transport> MakeTransport(const ServiceOptions& options) {
  std::unique_ptr<Transport> transport = std::make_unique<LcmTransport>(options.lcm_url);
  if (options.drop > 0.0)
    transport = std::make_unique<LossyTransport>(std::move(transport), options.drop, options.drop_seed);
  return transport;
}

/// Runs until the end, and ends the process itself if the node does not come back from a long computation: the
/// histories are whole at any time. The exit code after a signal is that of a process that died of it: whoever watches
/// over the service sees that it has not finished.
int RunToTheEnd(const std::string& program, ServiceRunner& runner) {
  constexpr std::chrono::milliseconds kPatience{500};
  int code = 0;
  {
    const StopSignal stop([&runner] { runner.Stop(); });
    try {
      runner.Run();
      if (stop.number() != 0) code = 128 + stop.number();
    } catch (const std::exception& error) {
      (void)ReportFailure(program, error);
      code = 2;
    }
  }
  if (!runner.JoinFold(kPatience)) std::_Exit(code);
  return code;
}

}  // namespace

int RunService(std::string_view service_name, int argc, char** argv, const NodeFactory& make_node,
               const OfflineJob& offline) {
  const std::string service(service_name);
  ServiceOptions options;
  if (const std::optional<int> code = ReadOptions(service, argc, argv, offline != nullptr, options)) return *code;
  try {
    if (options.offline) {
      offline(options.run_folder);
      return 0;
    }
    const RunConfig config = ReadRunConfig(options.run_folder);
    const std::unique_ptr<Node> node = make_node(config);
    if (options.check) return 0;
    const std::unique_ptr<Transport> transport = MakeTransport(options);
    const bool paced = service == "robot" && config.realtime;
    ServiceRunner runner(
        {service, config.run_id, options.run_folder, paced, options.without, options.exit_when_finished}, *node,
        *transport);
    return RunToTheEnd("nbs-" + service, runner);
  } catch (const std::exception& error) {
    return ReportFailure("nbs-" + service, error);
  }
}

}  // namespace nbs
