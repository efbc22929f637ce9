#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>

#include "common/runtime/node.h"

namespace nbs {

/// Hands messages from the thread that receives to the one that folds; one unbounded queue per stream.
class InputQueues {
 public:
  void Push(size_t stream, Message message);

  /// Takes the next message of the stream; waits for it. nullopt once the queues are closed.
  std::optional<Message> Pop(size_t stream);

  /// Ends all waiting, now and later.
  void Close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<size_t, std::deque<Message>> queues_;
  bool closed_ = false;
};

}  // namespace nbs
