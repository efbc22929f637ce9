#pragma once

#include <vector>

#include "common/config/run_config.h"
#include "services/reporter/report_picture.h"
#include "services/reporter/run_record.h"
#include "services/reporter/run_traces.h"

namespace nbs {

/// The robot half-way on each scan path: its collision bodies, the sensor with its beams, the table, the path, and
/// the mesh after the scan; what this scan added is tinted. A free-flying sensor is drawn alone.
///
/// Each scan is shown from the side on which more of its beams can be seen.
std::vector<ReportPicture> DrawScans(const RunConfig& config, const RunRecord& record, const RunTraces& traces);

}  // namespace nbs
