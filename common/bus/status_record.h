#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/bus/flight.h"
#include "common/bus/history.h"
#include "common/bus/status.h"

namespace nbs {

/// Keeps a service's heartbeats for the run's log, in RUN/streams/status: every change of state, and otherwise one a
/// second.
class StatusRecord {
 public:
  /// @throws as History does.
  StatusRecord(const std::filesystem::path& run_folder, const std::string& service);

  /// @throws RunFailure if the disk is full.
  void Offer(const ServiceStatus& status, std::span<const uint8_t> encoded, Instant now);

 private:
  History history_;
  Instant last_{};
  ServiceState last_state_ = ServiceState::kStarting;
};

}  // namespace nbs
