#include "common/bus/publisher.h"

#include <algorithm>

namespace nbs {
namespace {

// A datagram that nobody has acknowledged after this time no longer lies in a buffer: it was lost, or its receiver
// stands still and loses whatever comes.
constexpr std::chrono::milliseconds kLongestFlight{30};

// Receivers give credit by themselves before the window is full, unless its messages differ much in size.
constexpr std::chrono::milliseconds kPatienceForCredit{1};

}  // namespace

Publisher::Publisher(std::vector<OutputSetup> outputs, int64_t window_bytes, bool paced) : ledger_(window_bytes) {
  for (OutputSetup& setup : outputs) {
    Output output;
    for (const std::string& receiver : setup.receivers) output.received[receiver] = 0;
    output.published = setup.store->size();
    output.setup = std::move(setup);
    outputs_.push_back(std::move(output));
  }
  if (paced) pacer_.emplace();
}

void Publisher::OnStatus(const ServiceStatus& status) {
  for (const InputStatus& row : status.inputs) {
    for (Output& output : outputs_) {
      if (row.channel != output.setup.channel) continue;
      const auto receiver = output.received.find(status.service);
      if (receiver != output.received.end()) receiver->second = std::min(row.received, output.published);
    }
    ledger_.Retire([&](const Flight& flight) {
      const Output& output = outputs_[flight.output];
      if (flight.requester.empty()) return CalcAcknowledged(output) > flight.seq;
      return flight.requester == status.service && row.channel == output.setup.channel && row.received > flight.seq;
    });
  }
}

void Publisher::OnRepairRequest(const RepairRequest& request) {
  for (size_t i = 0; i < outputs_.size(); ++i) {
    if (outputs_[i].setup.channel != request.channel) continue;
    for (const int64_t seq : request.seqs) {
      if (seq < 0 || seq >= outputs_[i].published) continue;
      if (queued_.insert({i, seq}).second) repairs_.push_back({i, seq, request.service});
    }
  }
}

int64_t Publisher::CalcAcknowledged(const Output& output) {
  int64_t least = output.published;
  for (const auto& [receiver, count] : output.received) least = std::min(least, count);
  return least;
}

std::string Publisher::FindSlowest(const Output& output) {
  const auto slowest = std::ranges::min_element(output.received, {}, [](const auto& entry) { return entry.second; });
  return slowest == output.received.end() ? std::string() : slowest->first;
}

int64_t Publisher::CalcCost(const Output& output, int64_t seq) {
  return output.setup.store->CalcKernelBytesBefore(seq + 1) - output.setup.store->CalcKernelBytesBefore(seq);
}

int64_t Publisher::CalcLead() const {
  int64_t lead = 0;
  for (const Output& output : outputs_) {
    const MessageStore& store = *output.setup.store;
    lead += store.CalcKernelBytesBefore(output.published) - store.CalcKernelBytesBefore(CalcAcknowledged(output));
  }
  return lead;
}

bool Publisher::MayGo(int64_t kernel_bytes) const {
  const int64_t lead = CalcLead();
  return ledger_.HasRoom(kernel_bytes) && (lead == 0 || lead + kernel_bytes <= ledger_.window_bytes());
}

void Publisher::Launch(size_t index, int64_t seq, const std::string& requester, Instant now, Transport& transport) {
  const Output& output = outputs_[index];
  transport.Publish(output.setup.channel, output.setup.store->Read(seq));
  ledger_.Add({index, seq, requester, CalcCost(output, seq), now});
}

bool Publisher::SendRepairs(Instant now, Transport& transport) {
  bool sent = false;
  while (!repairs_.empty()) {
    const Repair repair = repairs_.front();
    if (!ledger_.HasRoom(CalcCost(outputs_[repair.output], repair.seq))) break;
    Launch(repair.output, repair.seq, repair.requester, now, transport);
    ++outputs_[repair.output].repaired;
    queued_.erase({repair.output, repair.seq});
    repairs_.pop_front();
    sent = true;
  }
  return sent;
}

bool Publisher::SendLive(size_t index, Instant now, Transport& transport) {
  Output& output = outputs_[index];
  const int64_t first = output.published;
  const int64_t recorded = output.setup.store->size();
  while (output.published < recorded) {
    if (pacer_) {
      const Instant due = pacer_->CalcDue(output.setup.store->utime_us(output.published), now);
      if (due > now) {
        next_due_ = next_due_ ? std::min(*next_due_, due) : due;
        break;
      }
    }
    if (!MayGo(CalcCost(output, output.published))) {
      if (!output.stalled) {
        ++output.stalls;
        stalled_since_ = now;
      }
      output.stalled = true;
      break;
    }
    output.stalled = false;
    Launch(index, output.published, {}, now, transport);
    ++output.published;
  }
  return output.published > first;
}

bool Publisher::Send(Instant now, Transport& transport) {
  next_due_.reset();
  ledger_.Retire([&](const Flight& flight) { return now - flight.sent > kLongestFlight; });
  bool sent = SendRepairs(now, transport);
  for (size_t i = 0; i < outputs_.size(); ++i) sent = SendLive(i, now, transport) || sent;
  return sent;
}

bool Publisher::TakeCreditWish(Instant now) {
  if (!stalled_since_ || now - *stalled_since_ < kPatienceForCredit) return false;
  stalled_since_.reset();
  return true;
}

bool Publisher::HasBacklog() const {
  return !repairs_.empty() || std::ranges::any_of(outputs_, [](const Output& output) {
    return output.published < output.setup.store->size();
  });
}

bool Publisher::IsAllAcknowledged() const {
  return std::ranges::all_of(
      outputs_, [](const Output& output) { return CalcAcknowledged(output) == output.setup.store->size(); });
}

std::vector<OutputStatus> Publisher::MakeStatus() const {
  std::vector<OutputStatus> rows;
  for (const Output& output : outputs_) {
    OutputStatus row;
    row.channel = output.setup.channel;
    row.published = output.published;
    row.recorded = output.setup.store->size();
    row.acknowledged = CalcAcknowledged(output);
    row.window = ledger_.window_bytes();
    row.stalls = output.stalls;
    row.repaired = output.repaired;
    if (output.stalled) row.waits_for = FindSlowest(output);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace nbs
