#include "common/bus/fold.h"

#include <chrono>
#include <exception>

#include "common/messages/translate.h"

namespace nbs {

Fold::Fold(Node& node, Recorder& recorder, InputQueues& queues, std::function<void()> on_output)
    : node_(node), recorder_(recorder), queues_(queues), on_output_(std::move(on_output)) {
  progress_.recovering = recorder_.IsRecovering();
}

FoldProgress Fold::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

template <typename Change>
void Fold::Update(Change&& change) {
  const std::lock_guard lock(mutex_);
  change(progress_);
}

void Fold::Run() {
  try {
    Outbox out;
    node_.Start(out);
    Publish(std::move(out));
    while (Step()) {
    }
  } catch (const std::exception& error) {
    Update([&](FoldProgress& progress) { progress.failure = error.what(); });
  }
  on_output_();
}

bool Fold::Step() {
  const size_t stream = node_.NextInput();
  Update([&](FoldProgress& progress) {
    progress.needs = stream;
    progress.finished = stream == Node::kNoInput;
  });
  if (stream == Node::kNoInput) return false;
  const std::optional<Message> message = queues_.Pop(stream);
  if (!message) return false;
  Outbox out;
  const auto begin = std::chrono::steady_clock::now();
  node_.Handle(*message, out);
  const auto busy = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin);
  busy_ns_ += busy.count();
  Publish(std::move(out));
  Update([&](FoldProgress& progress) {
    ++progress.processed[stream];
    progress.busy_us = busy_ns_ / 1000;
    progress.utime_us = CalcUtime(*message);
  });
  return true;
}

void Fold::Publish(Outbox out) {
  const bool any = !out.empty();
  recorder_.Record(std::move(out));
  std::vector<std::pair<std::string, int64_t>> complaints;
  for (const Node::Count& count : node_.Complaints()) complaints.emplace_back(count.name, count.count);
  Update([&](FoldProgress& progress) {
    progress.recovering = recorder_.IsRecovering();
    progress.complaints = std::move(complaints);
  });
  if (any) on_output_();
}

}  // namespace nbs
