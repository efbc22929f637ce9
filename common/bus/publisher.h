#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/flight.h"
#include "common/bus/message_store.h"
#include "common/bus/pacer.h"
#include "common/bus/status.h"
#include "common/bus/transport.h"

namespace nbs {

/// One stream that a service publishes.
struct OutputSetup {
  std::string channel;
  const MessageStore* store = nullptr;  ///< Where the messages are recorded before they go out. Outlives the publisher.
  std::vector<std::string> receivers;   ///< Those that the window waits for.
};

/// Publishes the streams of one service from their stores, and answers for what was lost.
///
/// Live messages go out in order; their publisher stays at most one window ahead of the slowest required receiver, as
/// that receiver's heartbeat tells (a receiver that has not been heard has received nothing). What a store holds when
/// the publisher is made counts as published. Repair goes before live messages and takes its bytes out of the same
/// window.
class Publisher {
 public:
  /// @param window_bytes  Credit window (CalcWindowBytes).
  /// @param paced         Live messages go out at the pace of simulated time.
  Publisher(std::vector<OutputSetup> outputs, int64_t window_bytes, bool paced);

  /// Takes the credit from a receiver's heartbeat.
  void OnStatus(const ServiceStatus& status);

  /// Queues the messages asked for; numbers that have not been published yet are passed over.
  void OnRepairRequest(const RepairRequest& request);

  /// Sends what the window allows. Returns true if anything went out.
  bool Send(Instant now, Transport& transport);

  /// True once when the window has been full for a millisecond: time to ask the receivers for credit by a heartbeat.
  bool TakeCreditWish(Instant now);
  /// True while anything waits for the window, for credit or in the pacer.
  bool HasBacklog() const;
  bool IsAllAcknowledged() const;
  /// When the pacer lets the next message go; nullopt if nothing waits for it.
  std::optional<Instant> next_due() const { return next_due_; }
  std::vector<OutputStatus> MakeStatus() const;
  const FlightLedger& ledger() const { return ledger_; }

 private:
  struct Output {
    OutputSetup setup;
    std::map<std::string, int64_t> received;  // By required receiver: messages in order.
    int64_t published = 0;
    int64_t stalls = 0;
    int64_t repaired = 0;
    bool stalled = false;
  };
  struct Repair {
    size_t output;
    int64_t seq;
    std::string requester;
  };

  static int64_t CalcAcknowledged(const Output& output);
  static std::string FindSlowest(const Output& output);
  static int64_t CalcCost(const Output& output, int64_t seq);
  int64_t CalcLead() const;
  bool MayGo(int64_t kernel_bytes) const;
  bool SendRepairs(Instant now, Transport& transport);
  bool SendLive(size_t index, Instant now, Transport& transport);
  void Launch(size_t index, int64_t seq, const std::string& requester, Instant now, Transport& transport);

  std::vector<Output> outputs_;
  FlightLedger ledger_;
  std::optional<Pacer> pacer_;
  std::optional<Instant> next_due_;
  std::optional<Instant> stalled_since_;  // The window was found full and credit has not been asked for yet.
  std::deque<Repair> repairs_;
  std::set<std::pair<size_t, int64_t>> queued_;  // What repairs_ holds.
};

}  // namespace nbs
