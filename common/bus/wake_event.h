#pragma once

namespace nbs {

/// A file descriptor that poll() can wait for and another thread, or a signal handler, can make readable.
class WakeEvent {
 public:
  /// @throws RunFailure if the process has no file descriptor left.
  WakeEvent();
  ~WakeEvent();
  WakeEvent(const WakeEvent&) = delete;
  WakeEvent& operator=(const WakeEvent&) = delete;

  int descriptor() const { return descriptor_; }
  void Set();
  void Clear();

 private:
  int descriptor_;
};

}  // namespace nbs
