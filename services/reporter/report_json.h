#pragma once

#include <filesystem>
#include <string>

#include "common/config/run_config.h"
#include "services/reporter/run_record.h"

namespace nbs {

/// The text of report.json: one object with the keys of the run folder's contract (README.md of this folder). Keys that
/// do not apply are null.
///
/// @param findings  What the truth says.
/// @param wall_s  From the start of the run to its last message, seconds.
std::string MakeReportJson(const RunConfig& config, const RunRecord& record, const Findings& findings, double wall_s);

}  // namespace nbs
