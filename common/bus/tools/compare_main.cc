#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "common/bus/compare.h"

/// nbs-compare: whether a replay made the recorded streams again, byte for byte. Exit code 0: it did; 1: bad input; 2:
/// it did not, or a log is missing or damaged. Of a run that was cut short only what was recorded is compared.
int main(int argc, char** argv) {
  CLI::App app{"Compares streams of a recorded log with the histories that another run made, byte for byte."};
  std::string log;
  std::string streams;
  std::vector<std::string> channels;
  app.add_option("--log", log, "Recorded log (bus.lcm)")->required();
  app.add_option("--streams", streams, "Folder with the histories of the other run (RUN/streams)")->required();
  app.add_option("--channels", channels, "Channels to compare, separated by commas")->delimiter(',')->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  }
  int code = 0;
  try {
    const bool ended = nbs::CameToItsEnd(log);
    if (!ended) std::printf("the recorded run was cut short: what was made beyond its record is not compared\n");
    for (const std::string& channel : channels) {
      const nbs::ChannelComparison result = nbs::CompareChannel(log, streams, channel, ended);
      std::printf("%s: %lld recorded, %lld made, %lld identical\n", channel.c_str(),
                  static_cast<long long>(result.recorded), static_cast<long long>(result.made),
                  static_cast<long long>(result.identical));
      if (result.difference.empty()) continue;
      if (code == 0) std::fprintf(stderr, "nbs-compare: %s\n", result.difference.c_str());
      code = 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nbs-compare: %s\n", error.what());
    return 2;
  }
  return code;
}
