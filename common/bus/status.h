#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nbs {

enum class ServiceState : uint8_t { kStarting = 0, kRecovering = 1, kReady = 2, kFinished = 3 };

/// starting, recovering, ready, finished.
std::string_view ToString(ServiceState state);

/// How far a service is with one of its input streams. All numbers are counts.
struct InputStatus {
  std::string channel;
  std::string sender;
  bool heard = false;     ///< The sender's heartbeat has been heard.
  int64_t received = 0;   ///< In order without a gap: the credit.
  int64_t processed = 0;  ///< Folded in: the barrier.
  int64_t gaps = 0;
  int64_t repairs = 0;  ///< Numbers asked for again.
  int64_t duplicates = 0;
  int64_t refused = 0;

  bool operator==(const InputStatus&) const = default;
};

/// How far a service is with one of its output streams. Numbers are counts where nothing else is said.
struct OutputStatus {
  std::string channel;
  int64_t published = 0;     ///< Sent at least once: the announced end.
  int64_t recorded = 0;      ///< In the history.
  int64_t acknowledged = 0;  ///< Received in order by every required receiver.
  int64_t window = 0;     ///< Kernel memory that may be on its way at a time, bytes; shared by the service's streams.
  int64_t stalls = 0;     ///< Times that the window was found full.
  int64_t repaired = 0;   ///< Sent again on request.
  std::string waits_for;  ///< Receiver that holds the window; empty if it is open.

  bool operator==(const OutputStatus&) const = default;
};

/// A service's heartbeat (lcmtypes/service_status_t.lcm).
struct ServiceStatus {
  int64_t run = 0;
  int64_t number = 0;
  int64_t utime_us = 0;
  int64_t busy_us = 0;  ///< Wall-clock time spent in folding messages.
  std::string service;
  int32_t pid = 0;
  ServiceState state = ServiceState::kStarting;
  std::string waits_for;  ///< "CHANNEL from SENDER" of the message that is needed next and not there; else empty.
  std::vector<InputStatus> inputs;
  std::vector<OutputStatus> outputs;
  std::vector<std::pair<std::string, int64_t>> complaints;

  bool operator==(const ServiceStatus&) const = default;
};

/// Asks for messages of a stream again (lcmtypes/repair_request_t.lcm).
struct RepairRequest {
  int64_t run = 0;
  std::string service;
  std::string channel;
  std::vector<int64_t> seqs;

  bool operator==(const RepairRequest&) const = default;
};
inline constexpr size_t kMaxRepairNumbers = 64;
inline constexpr const char* kRepairChannel = "REPAIR";

/// STATUS_<service>.
std::string StatusChannel(std::string_view service);

std::vector<uint8_t> EncodeStatus(const ServiceStatus& status);
std::vector<uint8_t> EncodeRepairRequest(const RepairRequest& request);

/// Checked decoding: nullopt for anything that the encoders above would not write.
std::optional<ServiceStatus> DecodeStatus(std::span<const uint8_t> data);
std::optional<RepairRequest> DecodeRepairRequest(std::span<const uint8_t> data);

}  // namespace nbs
