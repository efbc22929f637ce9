#include "tests/whole/network.h"

#include <algorithm>
#include <utility>

#include "common/messages/wiring.h"

namespace nbs {

void Network::Add(std::string_view service, std::unique_ptr<Node> node) {
  Member member{std::string(service), std::move(node), {}};
  for (const StreamWiring& wiring : Wiring()) {
    if (std::ranges::find(wiring.receivers, service) != wiring.receivers.end()) member.inputs[wiring.stream] = {};
  }
  members_.push_back(std::move(member));
}

void Network::Run(const Observer& observer) {
  for (Member& member : members_) {
    Outbox out;
    member.node->Start(out);
    Deliver(std::move(out), observer);
  }
  for (bool progress = true; progress;) {
    progress = false;
    for (Member& member : members_) {
      while (Step(member, observer)) progress = true;
    }
  }
}

bool Network::Step(Member& member, const Observer& observer) {
  const size_t stream = member.node->NextInput();
  if (stream == Node::kNoInput) return false;
  auto& queue = member.inputs.at(stream);
  if (queue.empty()) return false;
  const std::shared_ptr<const Message> message = queue.front();
  queue.pop_front();
  Outbox out;
  member.node->Handle(*message, out);
  Deliver(std::move(out), observer);
  return true;
}

void Network::Deliver(Outbox&& out, const Observer& observer) {
  for (Message& message : out) {
    if (observer) observer(message);
    const auto shared = std::make_shared<const Message>(std::move(message));
    for (Member& member : members_) {
      if (const auto input = member.inputs.find(shared->index()); input != member.inputs.end())
        input->second.push_back(shared);
    }
  }
}

}  // namespace nbs
