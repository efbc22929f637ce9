#include "common/bus/input_queues.h"

namespace nbs {

void InputQueues::Push(size_t stream, Message message) {
  const std::lock_guard lock(mutex_);
  queues_[stream].push_back(std::move(message));
  changed_.notify_one();
}

std::optional<Message> InputQueues::Pop(size_t stream) {
  std::unique_lock lock(mutex_);
  std::deque<Message>& queue = queues_[stream];
  changed_.wait(lock, [&] { return closed_ || !queue.empty(); });
  if (closed_) return std::nullopt;
  Message message = std::move(queue.front());
  queue.pop_front();
  return message;
}

void InputQueues::Close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace nbs
