#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/flight.h"
#include "common/bus/history.h"
#include "common/bus/status.h"

namespace nbs {

/// Keeps a service's heartbeats for the run's log, in RUN/streams/status: every change of state, otherwise one a
/// second, and the last.
class StatusRecord {
 public:
  /// @throws as History does.
  StatusRecord(const std::filesystem::path& run_folder, const std::string& service);

  /// @throws RunFailure if the disk is full.
  void Offer(const ServiceStatus& status, std::span<const uint8_t> encoded, Instant now);

  /// The last one, which is kept in any case.
  void Close(const ServiceStatus& status, std::span<const uint8_t> encoded);

 private:
  History history_;
  Instant last_{};
  ServiceState last_state_ = ServiceState::kStarting;
};

/// How long a service says in its last heartbeat that it was busy, seconds; nullopt if it has left none in the run
/// folder.
std::optional<double> ReadBusyTime(const std::filesystem::path& run_folder, const std::string& service);

}  // namespace nbs
