#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "common/bus/service_runner.h"

namespace nbs {

/// A folder of its own for one test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A service on a thread of its own.
class TestService {
 public:
  TestService(ServiceSetup setup, std::unique_ptr<Node> node, std::unique_ptr<Transport> transport);
  ~TestService() { Stop(); }

  void Stop();
  const ServiceRunner& runner() const { return *runner_; }
  /// The sentence with which it failed; empty if it did not. Valid after Stop.
  const std::string& failure() const { return failure_; }
  template <typename T>
  const T& node() const {
    return static_cast<const T&>(*node_);
  }
  /// Waits until the service has ended by itself (exit_when_finished, or a failure). False after the time limit.
  bool WaitForEnd(std::chrono::seconds limit) const;

 private:
  std::unique_ptr<Node> node_;
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<ServiceRunner> runner_;
  std::string failure_;
  std::atomic<bool> ended_{false};
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

/// udpm on a port that no other test uses, kept on this host.
std::string MakeTestUrl();

}  // namespace nbs
