#pragma once

#include <string>

#include "common/config/run_config.h"
#include "services/reporter/run_pictures.h"
#include "services/reporter/run_record.h"

namespace nbs {

/// The text of report.html, one file that needs nothing else: the run in figures, coverage and completeness over scans
/// and over path length, the table of scans, the verdicts with what each means, and the pictures.
std::string MakeReportHtml(const RunConfig& config, const RunRecord& record, const Findings& findings, double wall_s,
                           const RunPictures& pictures);

}  // namespace nbs
