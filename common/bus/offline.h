#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/bus/history.h"
#include "common/runtime/node.h"

namespace nbs {

/// Reads the messages of one stream from a run folder, in order.
class StreamReader {
 public:
  /// A stream without a history has no messages. @throws LogDamage if the history is damaged.
  StreamReader(const std::filesystem::path& run_folder, size_t stream);

  /// The next message; nullopt at the end. @throws RunFailure if it cannot be decoded.
  std::optional<Message> Next();

  int64_t size() const { return history_ ? history_->size() : 0; }

 private:
  size_t stream_;
  std::unique_ptr<History> history_;
  int64_t next_ = 0;
};

/// All messages of one type that a run has left. @throws as StreamReader does.
template <typename T>
std::vector<T> ReadAll(const std::filesystem::path& run_folder) {
  std::vector<T> all;
  StreamReader reader(run_folder, StreamOf<T>());
  while (auto message = reader.Next()) all.push_back(std::get<T>(std::move(*message)));
  return all;
}

/// Folds a run folder's histories into a node until the node has finished or the stream that it needs next has no more
/// messages. What the node publishes is dropped.
///
/// @returns The number of messages folded in.
/// @throws RunFailure if a history is damaged.
int64_t RunOffline(Node& node, const std::filesystem::path& run_folder);

}  // namespace nbs
