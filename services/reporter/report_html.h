#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "services/reporter/run_record.h"

namespace nbs {

/// A picture for the report: a PNG file's bytes.
struct ReportPicture {
  std::string caption;
  std::string png;
};

/// The text of report.html, one file that needs nothing else: the run in figures, coverage and completeness over scans
/// and over path length, the table of scans, the verdicts with what each means, and the pictures.
std::string MakeReportHtml(const RunConfig& config, const RunRecord& record, const Findings& findings, double wall_s,
                           const std::vector<ReportPicture>& pictures);

}  // namespace nbs
