#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/runtime/node.h"

namespace nbs {

/// All nodes of a run in one process, joined by queues after the wiring table instead of by the bus.
///
/// Since the nodes are a Kahn network, the result is that of any other schedule, and of the bus.
class Network {
 public:
  /// Sees each message that is published, in order of publication.
  using Observer = std::function<void(const Message&)>;

  /// Adds a service under its name in the wiring table.
  void Add(std::string_view service, std::unique_ptr<Node> node);

  /// Runs until no node can go on: every node has finished or waits for a message that nobody will send.
  void Run(const Observer& observer = {});

 private:
  struct Member {
    std::string service;
    std::unique_ptr<Node> node;
    std::map<size_t, std::deque<std::shared_ptr<const Message>>> inputs;  ///< By stream.
  };

  bool Step(Member& member, const Observer& observer);
  void Deliver(Outbox&& out, const Observer& observer);

  std::vector<Member> members_;
};

}  // namespace nbs
