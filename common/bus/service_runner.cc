#include "common/bus/service_runner.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "common/bus/window.h"
#include "common/messages/wiring.h"
#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

// How long a turn waits for datagrams while something has a timer of its own.
constexpr std::chrono::milliseconds kGapPatience{1};
constexpr std::chrono::milliseconds kWindowPatience{2};
constexpr std::chrono::milliseconds kFoldPatience{10};

}  // namespace

ServiceRunner::ServiceRunner(ServiceSetup setup, Node& node, Transport& transport)
    : setup_(std::move(setup)),
      transport_(transport),
      recorder_(setup_.service, setup_.run, setup_.run_folder),
      status_record_(setup_.run_folder, setup_.service),
      fold_(node, recorder_, queues_, [this] { transport_.Wake(); }),
      publisher_(MakeOutputs(), static_cast<int64_t>(CalcWindowBytes(setup_.service)), setup_.paced),
      peers_(Clock::now()) {
  for (const StreamWiring& wiring : Wiring()) {
    if (std::ranges::find(wiring.receivers, setup_.service) == wiring.receivers.end()) continue;
    inputs_.emplace(wiring.stream, Input{InputStream(wiring.stream, setup_.run)});
  }
  Subscribe();
}

ServiceRunner::~ServiceRunner() {
  queues_.Close();
  if (folding_.joinable()) folding_.join();
}

std::vector<OutputSetup> ServiceRunner::MakeOutputs() const {
  std::vector<OutputSetup> outputs;
  for (const auto& [stream, history] : recorder_.histories()) {
    OutputSetup output{history->channel(), history.get(), {}};
    for (const std::string_view receiver : Wiring()[stream].receivers) {
      if (std::ranges::find(setup_.without, receiver) == setup_.without.end()) output.receivers.emplace_back(receiver);
    }
    outputs.push_back(std::move(output));
  }
  return outputs;
}

void ServiceRunner::Subscribe() {
  std::set<std::string> channels;
  for (const StreamWiring& wiring : Wiring()) {
    if (wiring.sender == setup_.service) {
      channels.insert(kRepairChannel);
      for (const std::string_view receiver : wiring.receivers) channels.insert(StatusChannel(receiver));
    }
    if (!inputs_.contains(wiring.stream)) continue;
    channels.emplace(wiring.channel);
    channels.insert(StatusChannel(wiring.sender));
  }
  for (const std::string& channel : channels) transport_.Subscribe(channel);
}

void ServiceRunner::Run() {
  folding_ = std::thread([this] {
    fold_.Run();
    fold_ended_ = true;
  });
  while (!stop_) Turn();
  progress_ = fold_.progress();
  const ServiceStatus last = MakeStatus();
  status_record_.Close(last, EncodeStatus(last));
}

void ServiceRunner::Turn() {
  const FoldProgress before = progress_;
  progress_ = fold_.progress();
  if (!progress_.failure.empty()) throw RunFailure(progress_.failure);
  if (progress_.processed != before.processed || progress_.finished != before.finished) heartbeat_.NoteMoved();

  const Instant now = Clock::now();
  AskForMissing(now);
  if (publisher_.Send(now, transport_) || !publisher_.IsAllAcknowledged()) heartbeat_.NoteMoved();
  if (publisher_.TakeCreditWish(now)) heartbeat_.NoteHurry();
  if (heartbeat_.IsDue(now)) SendStatus(now);
  if (IsDone()) {
    stop_ = true;
    return;
  }
  transport_.Poll(CalcPatience(now),
                  [this](std::string_view channel, std::span<const uint8_t> data) { OnDatagram(channel, data); });
}

std::chrono::microseconds ServiceRunner::CalcPatience(Instant now) const {
  Instant until = heartbeat_.CalcDue();
  if (std::ranges::any_of(inputs_, [](const auto& entry) { return entry.second.stream.HasMissing(); })) {
    until = std::min(until, now + kGapPatience);
  }
  if (publisher_.HasBacklog()) until = std::min(until, publisher_.next_due().value_or(now + kWindowPatience));
  if (progress_.needs != Node::kNoInput && !IsStarved()) until = std::min(until, now + kFoldPatience);
  return std::max(std::chrono::duration_cast<std::chrono::microseconds>(until - now), std::chrono::microseconds(0));
}

void ServiceRunner::OnDatagram(std::string_view channel, std::span<const uint8_t> data) {
  for (auto& [stream, input] : inputs_) {
    if (input.stream.channel() == channel) return OnInput(stream, input, data);
  }
  if (channel != kRepairChannel) return OnPeerStatus(data);
  const std::optional<RepairRequest> request = DecodeRepairRequest(data);
  if (!request || request->run != setup_.run) return;
  publisher_.OnRepairRequest(*request);
}

void ServiceRunner::OnInput(size_t stream, Input& input, std::span<const uint8_t> data) {
  std::vector<Message> in_order;
  input.stream.OnDatagram(data, Clock::now(), in_order);
  for (Message& message : in_order) queues_.Push(stream, std::move(message));
  heartbeat_.NoteMoved();
  const auto bytes = static_cast<int64_t>(EstimateKernelBytes(data.size()));
  input.kernel_bytes += bytes;
  input.largest = std::max(input.largest, bytes);
  if (input.kernel_bytes < CalcCreditStep(input.window, input.largest)) return;
  SendStatus(Clock::now());
}

void ServiceRunner::OnPeerStatus(std::span<const uint8_t> data) {
  const std::optional<ServiceStatus> status = DecodeStatus(data);
  if (!status || status->run != setup_.run) return;
  if (peers_.NoteHeard(*status, Clock::now())) heartbeat_.NoteHurry();
  publisher_.OnStatus(*status);
  for (const OutputStatus& output : status->outputs) {
    for (auto& [stream, input] : inputs_) {
      if (input.stream.channel() != output.channel || input.stream.sender() != status->service) continue;
      input.stream.OnAnnouncedEnd(output.published);
      input.window = output.window;
      if (output.acknowledged >= input.stream.status().received) continue;
      // The sender lacks credit: the heartbeat with it was lost, or it is for messages too small to have hurried one.
      output.waits_for.empty() ? heartbeat_.NoteMoved() : heartbeat_.NoteHurry();
    }
  }
}

void ServiceRunner::AskForMissing(Instant now) {
  for (auto& [stream, input] : inputs_) {
    while (true) {
      std::vector<int64_t> seqs = input.stream.TakeNumbersToAsk(now);
      if (seqs.empty()) break;
      const RepairRequest request{setup_.run, setup_.service, input.stream.channel(), std::move(seqs)};
      transport_.Publish(kRepairChannel, EncodeRepairRequest(request));
    }
  }
}

int64_t ServiceRunner::CountProcessed(size_t stream) const {
  const auto processed = progress_.processed.find(stream);
  return processed == progress_.processed.end() ? 0 : processed->second;
}

bool ServiceRunner::IsStarved() const {
  const auto input = inputs_.find(progress_.needs);
  return input != inputs_.end() && CountProcessed(input->first) == input->second.stream.status().received;
}

ServiceState ServiceRunner::CalcState() const {
  if (progress_.finished) return ServiceState::kFinished;
  if (statuses_ == 0) return ServiceState::kStarting;
  return progress_.recovering ? ServiceState::kRecovering : ServiceState::kReady;
}

ServiceStatus ServiceRunner::MakeStatus() const {
  ServiceStatus status;
  status.run = setup_.run;
  status.number = statuses_;
  status.utime_us = progress_.utime_us;
  status.busy_us = progress_.busy_us;
  status.service = setup_.service;
  status.pid = getpid();
  status.state = CalcState();
  for (const auto& [stream, input] : inputs_) {
    InputStatus row = input.stream.status();
    row.processed = CountProcessed(stream);
    if (progress_.needs == stream && IsStarved()) status.waits_for = row.channel + " from " + row.sender;
    status.inputs.push_back(std::move(row));
  }
  status.outputs = publisher_.MakeStatus();
  status.complaints = progress_.complaints;
  return status;
}

void ServiceRunner::SendStatus(Instant now) {
  const ServiceStatus status = MakeStatus();
  const std::vector<uint8_t> data = EncodeStatus(status);
  transport_.Publish(StatusChannel(setup_.service), data);
  status_record_.Offer(status, data, now);
  heartbeat_.NoteSent(now);
  if (CalcState() == ServiceState::kStarting) heartbeat_.NoteMoved();
  for (auto& [stream, input] : inputs_) input.kernel_bytes = 0;
  ++statuses_;
  Report(status, now);
}

void ServiceRunner::Report(const ServiceStatus& status, Instant now) {
  const auto print = [this](std::string_view text) {
    std::fprintf(stderr, "nbs-%s: %s\n", setup_.service.c_str(), std::string(text).c_str());
  };
  if (status.state != state_told_) print(ToString(status.state));
  state_told_ = status.state;
  const std::string late = peers_.FindLate(status, now);
  if (!late.empty()) print(late);
}

bool ServiceRunner::IsDone() const {
  const bool may_end = setup_.exit_when_finished || recorder_.histories().empty();
  return may_end && progress_.finished && publisher_.IsAllAcknowledged() && state_told_ == ServiceState::kFinished;
}

void ServiceRunner::Stop() {
  stop_ = true;
  transport_.Wake();
}

bool ServiceRunner::JoinFold(std::chrono::milliseconds patience) {
  queues_.Close();
  const Instant limit = Clock::now() + patience;
  while (folding_.joinable() && !fold_ended_) {
    if (Clock::now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (folding_.joinable()) folding_.join();
  return true;
}

}  // namespace nbs
