#include "common/bus/offline.h"

#include <map>

#include "common/messages/translate.h"
#include "common/messages/wiring.h"
#include "common/runtime/run_failure.h"

namespace nbs {

StreamReader::StreamReader(const std::filesystem::path& run_folder, size_t stream) : stream_(stream) {
  const std::string channel(Wiring()[stream].channel);
  const std::filesystem::path file = HistoryPath(run_folder, channel);
  if (std::filesystem::exists(file)) history_ = std::make_unique<History>(file, channel, History::Access::kRead);
}

std::optional<Message> StreamReader::Next() {
  if (next_ >= size()) return std::nullopt;
  Decoded decoded = Decode(stream_, history_->Read(next_));
  if (!decoded.message) {
    throw RunFailure("message " + std::to_string(next_) + " in the history of " + history_->channel() +
                     " cannot be read: " + decoded.refusal);
  }
  ++next_;
  return std::move(decoded.message);
}

int64_t RunOffline(Node& node, const std::filesystem::path& run_folder) {
  std::map<size_t, StreamReader> readers;
  Outbox dropped;
  node.Start(dropped);
  int64_t folded = 0;
  for (size_t stream = node.NextInput(); stream != Node::kNoInput; stream = node.NextInput()) {
    auto reader = readers.find(stream);
    if (reader == readers.end()) reader = readers.emplace(stream, StreamReader(run_folder, stream)).first;
    const std::optional<Message> message = reader->second.Next();
    if (!message) break;
    dropped.clear();
    node.Handle(*message, dropped);
    ++folded;
  }
  return folded;
}

}  // namespace nbs
