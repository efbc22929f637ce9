#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace nbs {

/// A child process.
class Child {
 public:
  /// Starts the program with arguments; its stderr goes to a file if one is named.
  explicit Child(const std::vector<std::string>& command, const std::string& stderr_file = {});
  /// Kills it if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void Signal(int number) const;
  /// Waits for its end: the exit code, or 128 + the signal's number; -1 if it still runs after the time limit.
  int Wait(double limit_s);
  /// True if it has not ended by itself, but died of a signal.
  bool was_killed() const { return was_killed_; }

 private:
  pid_t pid_;
  int code_ = -1;
  bool was_killed_ = false;
};

/// Path of the service with fake nodes (probe_service.cc).
std::string ProbeService();

}  // namespace nbs
