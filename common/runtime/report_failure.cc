#include "common/runtime/report_failure.h"

#include <iostream>

#include "common/runtime/error.h"

namespace nbs {

int ReportFailure(std::string_view program, const std::exception& error) {
  std::cerr << program << ": " << error.what() << "\n";
  return dynamic_cast<const ConfigError*>(&error) != nullptr ? 1 : 2;
}

}  // namespace nbs
