#pragma once

#include <stdexcept>

namespace nbs {

/// Bad input or configuration that the user can mend. The text is one sentence that names file, line where there is
/// one, and remedy. Mains print it and exit with code 1.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nbs
