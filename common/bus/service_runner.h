#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/fold.h"
#include "common/bus/heartbeat.h"
#include "common/bus/input_stream.h"
#include "common/bus/peers.h"
#include "common/bus/publisher.h"
#include "common/bus/recorder.h"
#include "common/bus/status.h"
#include "common/bus/status_record.h"
#include "common/bus/transport.h"

namespace nbs {

/// What a service needs to know to take part in a run.
struct ServiceSetup {
  std::string service;  ///< Name in the wiring table.
  int64_t run = 0;
  std::filesystem::path run_folder;
  bool paced = false;                ///< Outputs go out at the pace of simulated time.
  std::vector<std::string> without;  ///< Services that do not take part: their credit is not waited for.
  bool exit_when_finished =
      false;  ///< Ends when the node has finished and all has been received, instead of serving repair until stopped.
};

/// A service on the bus: one thread that talks with the bus (receives, publishes, repairs, sends the heartbeat) and one
/// that folds.
class ServiceRunner {
 public:
  /// Opens the histories and joins the bus. Node and transport outlive the runner.
  ///
  /// @throws ConfigError, LogDamage as History and Transport do.
  ServiceRunner(ServiceSetup setup, Node& node, Transport& transport);
  ~ServiceRunner();

  /// Takes part in the run until Stop, or until the node has finished and nobody needs the service any more: because it
  /// publishes nothing, or with exit_when_finished once its outputs have been received.
  ///
  /// @throws RunFailure, in one sentence, if the run cannot go on.
  void Run();

  /// Ends Run. Safe from any thread and from a signal handler.
  void Stop();

  /// Waits until the node has returned from its last Handle; false if it has not within that time. Until then node and
  /// runner must not be destroyed.
  bool JoinFold(std::chrono::milliseconds patience);

  /// The heartbeat as it would be sent now. For the thread that calls Run, or after it.
  ServiceStatus MakeStatus() const;
  const Publisher& publisher() const { return publisher_; }

 private:
  struct Input {
    InputStream stream;
    int64_t kernel_bytes = 0;  // Received since the last heartbeat.
    int64_t largest = 0;       // Kernel bytes of the largest message so far.
    int64_t window = 0;        // Of the sender, as it announces it.
  };

  std::vector<OutputSetup> MakeOutputs() const;
  void Subscribe();
  void Turn();
  void OnDatagram(std::string_view channel, std::span<const uint8_t> data);
  void OnInput(size_t stream, Input& input, std::span<const uint8_t> data);
  void OnPeerStatus(std::span<const uint8_t> data);
  void AskForMissing(Instant now);
  void SendStatus(Instant now);
  void Report(const ServiceStatus& status, Instant now);
  int64_t CountProcessed(size_t stream) const;
  bool IsStarved() const;
  ServiceState CalcState() const;
  bool IsDone() const;
  std::chrono::microseconds CalcPatience(Instant now) const;

  ServiceSetup setup_;
  Transport& transport_;
  Recorder recorder_;
  StatusRecord status_record_;
  InputQueues queues_;
  Fold fold_;
  std::map<size_t, Input> inputs_;  // By stream number.
  Publisher publisher_;
  Peers peers_;
  HeartbeatClock heartbeat_;
  FoldProgress progress_;  // As of this turn.
  int64_t statuses_ = 0;
  ServiceState state_told_ = ServiceState::kStarting;  // Last one that was printed.
  std::atomic<bool> stop_{false};
  std::atomic<bool> fold_ended_{false};
  std::thread folding_;
};

}  // namespace nbs
