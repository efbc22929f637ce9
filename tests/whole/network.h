#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/lcm_transport.h"
#include "common/runtime/node.h"

namespace nbs {

/// All nodes of a run in one process, on LCM's own queue within a process (memq): every message is cut, encoded,
/// published, received and decoded as on the network, but none can be lost.
///
/// Since the nodes are a Kahn network, the result is that of any other schedule, and of the network.
class Network {
 public:
  /// Sees each message that is published, in order of publication.
  using Observer = std::function<void(const Message&)>;

  Network();

  /// Adds a service under its name in the wiring table.
  void Add(std::string_view service, std::unique_ptr<Node> node);

  /// Runs until no node can go on: every node has finished or waits for a message that nobody will send.
  ///
  /// @throws std::logic_error if a message is refused by its decoder.
  void Run(const Observer& observer = {});

 private:
  struct Member {
    std::string service;
    std::unique_ptr<Node> node;
    std::map<size_t, std::deque<std::shared_ptr<const Message>>> inputs;  ///< By stream.
  };

  bool Step(Member& member, const Observer& observer);
  void Publish(Outbox&& out, const Observer& observer);
  void Receive();
  void Accept(std::string_view channel, std::span<const uint8_t> data);

  LcmTransport bus_;
  int64_t published_ = 0;
  int64_t received_ = 0;
  std::vector<Member> members_;
};

}  // namespace nbs
