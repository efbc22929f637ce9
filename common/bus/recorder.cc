#include "common/bus/recorder.h"

#include <algorithm>
#include <stdexcept>

#include "common/messages/translate.h"
#include "common/messages/wiring.h"
#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

// Durations by the wall clock are never the same twice; the first ones stand.
bool IsRepeatable(size_t stream) { return stream != StreamOf<PlanTiming>(); }

}  // namespace

Recorder::Recorder(std::string service, int64_t run, const std::filesystem::path& run_folder)
    : service_(std::move(service)), run_(run) {
  for (const StreamWiring& wiring : Wiring()) {
    if (wiring.sender != service_) continue;
    auto history = std::make_unique<History>(HistoryPath(run_folder, wiring.channel), std::string(wiring.channel),
                                             History::Access::kAppend);
    made_[wiring.stream] = 0;
    recorded_at_start_[wiring.stream] = history->size();
    histories_[wiring.stream] = std::move(history);
  }
}

void Recorder::Record(Outbox out) {
  for (Message& message : out) {
    for (const Message& part : SplitForBus(std::move(message))) RecordPart(part);
  }
}

void Recorder::RecordPart(const Message& part) {
  const auto found = histories_.find(part.index());
  if (found == histories_.end()) {
    throw std::logic_error(service_ + " is not the sender of " + std::string(Wiring()[part.index()].channel));
  }
  History& history = *found->second;
  const int64_t seq = made_[part.index()]++;
  const int64_t utime_us = CalcUtime(part);
  const std::vector<uint8_t> data = Encode({run_, seq, utime_us, service_}, part);
  if (seq >= history.size()) return history.Append(utime_us, data);
  if (!IsRepeatable(part.index())) return;
  const std::vector<uint8_t> recorded = history.Read(seq);
  if (recorded == data) return;
  const auto difference = std::ranges::mismatch(recorded, data).in1 - recorded.begin();
  throw RunFailure("message " + std::to_string(seq) + " on " + history.channel() +
                   ", made again from the same inputs, differs from the recorded one at byte " +
                   std::to_string(difference) + ": was the run folder made by another version or configuration?");
}

bool Recorder::IsRecovering() const {
  return std::ranges::any_of(made_,
                             [this](const auto& entry) { return entry.second < recorded_at_start_.at(entry.first); });
}

}  // namespace nbs
