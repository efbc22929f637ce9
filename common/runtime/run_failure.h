#pragma once

#include <stdexcept>

namespace nbs {

/// A run that cannot go on: disk full, a damaged history, outputs that differ from those recorded. The text is one
/// sentence. Mains print it and exit with code 2.
class RunFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nbs
