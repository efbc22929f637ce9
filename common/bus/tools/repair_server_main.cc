#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "common/bus/lcm_transport.h"
#include "common/bus/repair_server.h"
#include "common/bus/stop_signal.h"
#include "common/runtime/error.h"

/// nbs-repair-server: stands in for the senders of recorded streams during a replay. Exit code 0: stopped by a signal;
/// 1: bad input; 2: failed.
int main(int argc, char** argv) {
  CLI::App app{"Answers repair requests for recorded streams while lcm-logplayer plays them."};
  std::string log;
  std::string lcm_url;
  std::vector<std::string> channels;
  app.add_option("--log", log, "Recorded log (bus.lcm)")->required();
  app.add_option("--channels", channels, "Channels that are played, separated by commas")->delimiter(',')->required();
  app.add_option("--lcm-url", lcm_url, "Bus to join (default: LCM_DEFAULT_URL)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  }
  try {
    nbs::LcmTransport transport(lcm_url);
    nbs::RepairServer server(log, {channels.begin(), channels.end()}, transport);
    const nbs::StopSignal stop([&server] { server.Stop(); });
    std::fprintf(stderr, "nbs-repair-server: ready\n");
    server.Run();
  } catch (const nbs::ConfigError& error) {
    std::fprintf(stderr, "nbs-repair-server: %s\n", error.what());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nbs-repair-server: %s\n", error.what());
    return 2;
  }
  return 0;
}
