#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "common/config/run_config.h"
#include "common/runtime/node.h"

namespace nbs {

using NodeFactory = std::function<std::unique_ptr<Node>(const RunConfig&)>;

/// What a service does with a run folder without the bus.
using OfflineJob = std::function<void(const std::filesystem::path& run_folder)>;

/// The whole life of a service: reads the command line and RUN/run.yaml, makes the node, joins the bus, recovers what
/// the streams' histories hold, folds until the node has finished or SIGINT/SIGTERM comes. A service whose node has
/// finished stays: others may need its history.
///
/// Options: --run DIR (required); --lcm-url URL (default: LCM_DEFAULT_URL); --without A,B (services that do not take
/// part: their credit is not waited for);
/// --exit-when-finished (ends once the node has finished and its outputs have been received); --drop P --drop-seed N
/// (test only: loses that share of datagrams); --check (makes the node, which refuses what it cannot begin with, and
/// ends); --offline, where there is such a job (does it instead of joining the bus).
///
/// @param service  Name in the wiring table; decides which streams are read and published.
/// @returns The exit code: 0 finished; 1 bad input, in one sentence on stderr; 2 failed; 128 and its number: a signal.
int RunService(std::string_view service, int argc, char** argv, const NodeFactory& make_node,
               const OfflineJob& offline = nullptr);

}  // namespace nbs
