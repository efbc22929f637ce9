#include "common/bus/repair_server.h"

#include <unistd.h>

#include <algorithm>
#include <limits>

#include "common/bus/window.h"
#include "common/messages/translate.h"
#include "common/messages/wiring.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr std::chrono::seconds kSilence{1};

const StreamWiring& FindWiring(const std::string& channel) {
  const auto found = std::ranges::find(Wiring(), channel, &StreamWiring::channel);
  if (found == Wiring().end()) throw ConfigError(channel + " is not the channel of a stream: see lcmtypes/README.md");
  return *found;
}

int64_t CalcWindow(const std::set<std::string>& channels) {
  size_t window = 0;
  std::set<std::string_view> senders;
  for (const std::string& channel : channels) {
    const std::string_view sender = FindWiring(channel).sender;
    if (senders.insert(sender).second) window += CalcWindowBytes(sender);
  }
  return static_cast<int64_t>(window);
}

}  // namespace

RepairServer::RepairServer(const std::filesystem::path& log, const std::set<std::string>& channels,
                           Transport& transport)
    : transport_(transport),
      stores_(ReadLogStores(log, channels)),
      publisher_(MakeOutputs(), CalcWindow(channels), false),
      last_played_(Clock::now()) {
  std::set<std::string> subscribed = {kRepairChannel};
  for (const auto& [channel, store] : stores_) {
    if (store.size() == 0) throw ConfigError(log.string() + " has no messages on " + channel);
    run_ = store.run();
    const StreamWiring& wiring = FindWiring(channel);
    streams_[channel] = {wiring.stream};
    senders_.emplace(wiring.sender);
    subscribed.insert(channel);
    for (const std::string_view receiver : wiring.receivers) subscribed.insert(StatusChannel(receiver));
  }
  for (const std::string& channel : subscribed) transport_.Subscribe(channel);
}

std::vector<OutputSetup> RepairServer::MakeOutputs() const {
  std::vector<OutputSetup> outputs;
  for (const auto& [channel, store] : stores_) outputs.push_back({channel, &store, {}});
  return outputs;
}

void RepairServer::Run() {
  while (!stop_) {
    const Instant now = Clock::now();
    if (now - last_played_ > kSilence) AnnounceAll();
    if (publisher_.Send(now, transport_)) heartbeat_.NoteMoved();
    if (heartbeat_.IsDue(now)) {
      SendStatuses();
      heartbeat_.NoteSent(now);
    }
    const Instant until = publisher_.HasBacklog() ? now + std::chrono::milliseconds(5) : heartbeat_.CalcDue();
    const auto patience = std::chrono::duration_cast<std::chrono::microseconds>(until - now);
    transport_.Poll(
        std::max(patience, std::chrono::microseconds(0)),
        [this](std::string_view channel, std::span<const uint8_t> data) { OnDatagram(std::string(channel), data); });
  }
}

void RepairServer::Stop() {
  stop_ = true;
  transport_.Wake();
}

void RepairServer::OnDatagram(const std::string& channel, std::span<const uint8_t> data) {
  if (streams_.contains(channel)) return OnPlayed(channel, data);
  if (channel == kRepairChannel) {
    const std::optional<RepairRequest> request = DecodeRepairRequest(data);
    if (request && request->run == run_) publisher_.OnRepairRequest(*request);
    return;
  }
  const std::optional<ServiceStatus> status = DecodeStatus(data);
  if (status && status->run == run_) publisher_.OnStatus(*status);
}

void RepairServer::OnPlayed(const std::string& channel, std::span<const uint8_t> data) {
  const std::optional<MessageHeader> header = DecodeHeader(data);
  if (!header || header->run != run_ || header->seq < 0 || header->seq >= stores_.at(channel).size()) return;
  Stream& stream = streams_.at(channel);
  if (header->seq < stream.announced) return;
  stream.announced = header->seq + 1;
  last_played_ = Clock::now();
  heartbeat_.NoteMoved();
}

void RepairServer::AnnounceAll() {
  for (auto& [channel, stream] : streams_) {
    const int64_t end = stores_.at(channel).size();
    if (stream.announced == end) continue;
    stream.announced = end;
    heartbeat_.NoteMoved();
  }
}

void RepairServer::SendStatuses() {
  for (const std::string& sender : senders_)
    transport_.Publish(StatusChannel(sender), EncodeStatus(MakeStatus(sender)));
  ++statuses_;
}

ServiceStatus RepairServer::MakeStatus(const std::string& sender) const {
  ServiceStatus status;
  status.run = run_;
  status.number = statuses_;
  status.service = sender;
  status.pid = getpid();
  status.state = ServiceState::kReady;
  for (const StreamWiring& wiring : Wiring()) {
    if (std::ranges::find(wiring.receivers, sender) == wiring.receivers.end()) continue;
    InputStatus row;
    row.channel = wiring.channel;
    row.sender = wiring.sender;
    // The recorded sender has read whatever is published to it.
    row.received = row.processed = std::numeric_limits<int64_t>::max();
    status.inputs.push_back(std::move(row));
  }
  for (const OutputStatus& output : publisher_.MakeStatus()) {
    if (FindWiring(output.channel).sender != sender) continue;
    OutputStatus row = output;
    row.published = streams_.at(output.channel).announced;
    row.acknowledged = row.published;
    status.outputs.push_back(std::move(row));
  }
  return status;
}

}  // namespace nbs
