#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>

namespace nbs {

using Clock = std::chrono::steady_clock;
using Instant = Clock::time_point;

/// One datagram that may still lie in a kernel's receive buffer.
struct Flight {
  size_t output = 0;  ///< Which of the publisher's streams.
  int64_t seq = 0;
  std::string requester;  ///< The service that asked for it; empty: live, for all receivers.
  int64_t kernel_bytes = 0;
  Instant sent;
};

/// The datagrams of one service that are on their way, and whether another one fits its window.
class FlightLedger {
 public:
  explicit FlightLedger(int64_t window_bytes) : window_bytes_(window_bytes) {}

  /// True if the window has room for it. An empty window has room for one message of any size.
  bool HasRoom(int64_t kernel_bytes) const { return flights_.empty() || total_ + kernel_bytes <= window_bytes_; }

  void Add(Flight flight);

  /// Forgets the flights that have landed.
  void Retire(const std::function<bool(const Flight&)>& has_landed);

  int64_t window_bytes() const { return window_bytes_; }
  bool empty() const { return flights_.empty(); }
  /// Largest number of bytes on their way at any time.
  int64_t peak_bytes() const { return peak_; }

 private:
  int64_t window_bytes_;
  int64_t total_ = 0;
  int64_t peak_ = 0;
  std::deque<Flight> flights_;
};

}  // namespace nbs
