#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/bus/flight.h"
#include "common/bus/status.h"
#include "common/runtime/node.h"

namespace nbs {

/// Puts the messages of one stream in order: refuses what is damaged or of another run, drops what it has already, and
/// finds what is missing.
class InputStream {
 public:
  /// @param stream  Number of the stream.
  /// @param run     Messages of any other run are refused.
  InputStream(size_t stream, int64_t run);

  const std::string& channel() const { return status_.channel; }
  const std::string& sender() const { return status_.sender; }

  /// Takes a datagram of the stream's channel. Appends the messages that are now next in order.
  ///
  /// @throws RunFailure if the sender sends the next message damaged again and again.
  void OnDatagram(std::span<const uint8_t> data, Instant now, std::vector<Message>& in_order);

  /// Takes the sender's announced end: messages 0 … end - 1 have been published.
  void OnAnnouncedEnd(int64_t end);

  /// The missing numbers to ask for now, ascending, at most kMaxRepairNumbers; empty if nothing is missing or it is too
  /// early.
  ///
  /// A number is asked for when it has been missing for a few milliseconds, and again when a later one of the same
  /// request has come without it or the sender has been silent for a while. At most two requests are open at a time, so
  /// that a stream of any length flows in at the speed of the sender's window.
  std::vector<int64_t> TakeNumbersToAsk(Instant now);

  bool HasMissing() const { return FindKnownEnd() > status_.received; }
  /// received, gaps, repairs, duplicates, refused and heard; `processed` is the fold's to fill in.
  const InputStatus& status() const { return status_; }

 private:
  struct Asked {
    int64_t request;  // Number of the request that asked for it.
    bool lost;        // A later one of the request has come.
  };

  int64_t FindKnownEnd() const;
  void Refuse(int64_t seq, const std::string& why);
  void NoteArrival(int64_t seq, Instant now);
  void TakeInOrder(std::vector<Message>& in_order);

  size_t stream_;
  int64_t run_;
  InputStatus status_;
  int64_t announced_end_ = 0;
  std::map<int64_t, Message> early_;  // Came before one that is still missing.
  std::optional<Instant> missing_since_;
  std::map<int64_t, Asked> asked_;
  int64_t requests_ = 0;
  Instant last_arrival_{};
  Instant last_request_{};
  int next_refused_ = 0;  // Times that the next message in order came damaged after having been asked for.
};

}  // namespace nbs
