#pragma once

#include <string>

#include "sim/oracle/oracle.h"

namespace nbs {

/// The text of oracle.json: object, cell, what was asked for, `seen_by_any`, and `curves`: by what counts as covered
/// (`partner`, `seen`), rule (`scan`, `metre`) and start (`free`, `first_path`) coverage and path_length_m after each
/// scan, and in `reached` scans and metres for 95, 98, 99 and 99.9 % (null if never).
std::string MakeOracleJson(const RunConfig& config, const OracleSettings& settings, const OracleResult& result);

}  // namespace nbs
