#pragma once

#include <functional>

namespace nbs {

/// While it lives, SIGINT and SIGTERM call a function instead of ending the process. At most one at a time.
class StopSignal {
 public:
  /// @param on_signal  Called in the signal handler: it may only do what is safe there.
  explicit StopSignal(std::function<void()> on_signal);
  ~StopSignal();
  /// The signal that has come, 0 if none.
  int number() const;
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
};

}  // namespace nbs
