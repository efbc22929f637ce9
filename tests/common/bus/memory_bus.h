#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "common/bus/transport.h"

namespace nbs {

/// A bus within one process, for tests, with the one property of the real one that matters: each member has a receive
/// buffer of limited size, every datagram of every channel takes room in it, and what does not fit is lost.
class MemoryBus {
 public:
  /// @param receive_buffer  Bytes of kernel memory (EstimateKernelBytes) that a member holds before it polls.
  explicit MemoryBus(size_t receive_buffer);

  /// A new member; it may outlive the bus object.
  std::unique_ptr<Transport> Join();

  /// Datagrams lost so far, over all members.
  int64_t lost() const;
  /// Largest fill of any member's receive buffer so far.
  size_t peak_bytes() const;

 private:
  struct Datagram {
    std::string channel;
    std::vector<uint8_t> data;
  };
  struct Member {
    std::deque<Datagram> buffer;
    size_t bytes = 0;
    std::set<std::string, std::less<>> channels;
    bool woken = false;
  };
  struct Shared {
    mutable std::mutex mutex;
    std::condition_variable arrived;
    size_t receive_buffer = 0;
    std::vector<std::shared_ptr<Member>> members;
    int64_t lost = 0;
    size_t peak = 0;
  };
  class MemberTransport;

  std::shared_ptr<Shared> shared_;
};

}  // namespace nbs
