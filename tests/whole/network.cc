#include "tests/whole/network.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "common/messages/translate.h"
#include "common/messages/wiring.h"

namespace nbs {

Network::Network() : bus_("memq://") {
  for (const StreamWiring& wiring : Wiring()) bus_.Subscribe(std::string(wiring.channel));
}

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
    Publish(std::move(out), observer);
  }
  Receive();
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
  Publish(std::move(out), observer);
  Receive();
  return true;
}

void Network::Publish(Outbox&& out, const Observer& observer) {
  for (Message& message : out) {
    if (observer) observer(message);
    const StreamWiring& wiring = Wiring()[message.index()];
    for (const Message& part : SplitForBus(std::move(message))) {
      bus_.Publish(wiring.channel, Encode({.seq = published_++, .source = std::string(wiring.sender)}, part));
    }
  }
}

void Network::Receive() {
  while (received_ < published_) {
    bus_.Poll(std::chrono::seconds(1), [this](std::string_view channel, std::span<const uint8_t> data) {
      ++received_;
      Accept(channel, data);
    });
  }
}

void Network::Accept(std::string_view channel, std::span<const uint8_t> data) {
  const size_t stream = std::ranges::find(Wiring(), channel, &StreamWiring::channel)->stream;
  Decoded decoded = Decode(stream, data);
  if (!decoded.message) throw std::logic_error(std::string(channel) + ": " + decoded.refusal);
  const auto shared = std::make_shared<const Message>(std::move(*decoded.message));
  for (Member& member : members_) {
    if (const auto input = member.inputs.find(stream); input != member.inputs.end()) input->second.push_back(shared);
  }
}

}  // namespace nbs
