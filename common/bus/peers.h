#pragma once

#include <map>
#include <string>

#include "common/bus/flight.h"
#include "common/bus/status.h"

namespace nbs {

/// The other services that a service hears, and which of them is late.
class Peers {
 public:
  explicit Peers(Instant now) : since_(now), last_named_(now) {}

  /// Notes a heartbeat. Returns true if this process has not been heard before.
  bool NoteHeard(const ServiceStatus& status, Instant now);

  /// One sentence for the log that names a silent service for which `status` waits, at most every ten seconds; empty if
  /// there is nothing to say.
  std::string FindLate(const ServiceStatus& status, Instant now);

 private:
  bool IsSilent(const std::string& service, Instant now) const;

  struct Peer {
    int32_t pid;
    Instant heard;
  };
  std::map<std::string, Peer> peers_;
  Instant since_;
  Instant last_named_;
};

}  // namespace nbs
