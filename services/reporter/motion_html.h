#pragma once

#include <string>

#include "services/reporter/run_record.h"

namespace nbs {

/// The part of report.html on where the time went: the robot's, and the computer's.
std::string MakeTimeTable(const TimeSplit& time);

/// The part of report.html on what the executed motions did by the truth: each fault with its count and first place,
/// and what counts as one.
std::string MakeMotionTable(const MotionAudit& audit);

}  // namespace nbs
