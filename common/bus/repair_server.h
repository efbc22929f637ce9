#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/bus/heartbeat.h"
#include "common/bus/log_store.h"
#include "common/bus/publisher.h"
#include "common/bus/status.h"
#include "common/bus/transport.h"

namespace nbs {

/// Stands in for the senders of recorded streams while lcm-logplayer, which waits for nobody, plays them: sends again
/// what was lost, announces the ends, and gives the senders' credit to those who publish to them.
///
/// A stream's announced end follows what has been heard on its channel; after a second of silence on all of them, it is
/// the log's end.
class RepairServer {
 public:
  /// @throws ConfigError if the log cannot be opened, a channel is no stream or not in the log; LogDamage, RunFailure
  /// as ReadLogStores.
  RepairServer(const std::filesystem::path& log, const std::set<std::string>& channels, Transport& transport);

  /// Serves until Stop.
  void Run();

  /// Ends Run. Safe from any thread and from a signal handler.
  void Stop();

 private:
  struct Stream {
    size_t number;
    int64_t announced = 0;
  };

  std::vector<OutputSetup> MakeOutputs() const;
  void OnDatagram(const std::string& channel, std::span<const uint8_t> data);
  void OnPlayed(const std::string& channel, std::span<const uint8_t> data);
  void AnnounceAll();
  void SendStatuses();
  ServiceStatus MakeStatus(const std::string& sender) const;

  Transport& transport_;
  std::map<std::string, LogStore> stores_;
  std::map<std::string, Stream> streams_;
  std::set<std::string> senders_;
  int64_t run_ = 0;
  Publisher publisher_;
  HeartbeatClock heartbeat_;
  Instant last_played_;
  int64_t statuses_ = 0;
  std::atomic<bool> stop_{false};
};

}  // namespace nbs
