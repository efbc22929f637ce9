#pragma once

#include <exception>
#include <string_view>

namespace nbs {

/// Says on stderr, in one line, why a program ends: "PROGRAM: WHAT".
///
/// @returns Its exit code: 1 for a ConfigError, bad input that the user can mend; otherwise 2.
int ReportFailure(std::string_view program, const std::exception& error);

}  // namespace nbs
