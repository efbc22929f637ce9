#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/history.h"
#include "common/runtime/node.h"

namespace nbs {

/// Numbers, cuts and encodes what a service's node publishes, and writes it to the histories of its streams.
///
/// A node that was killed makes its first outputs again when it is started anew: those that its histories hold already
/// are compared, not written.
class Recorder {
 public:
  /// Opens the histories of all streams that the service sends. @throws as History does.
  Recorder(std::string service, int64_t run, const std::filesystem::path& run_folder);

  /// Takes what the node published, in order.
  ///
  /// @throws RunFailure if a message made again differs from the recorded one (wall-clock durations excepted), or the
  /// disk is full.
  /// @throws std::logic_error if the service is not the sender of such messages.
  void Record(Outbox out);

  /// True until everything that the histories held at the start has been made again.
  bool IsRecovering() const;

  /// By stream number, in that order.
  const std::map<size_t, std::unique_ptr<History>>& histories() const { return histories_; }

 private:
  void RecordPart(const Message& part);

  std::string service_;
  int64_t run_;
  std::map<size_t, std::unique_ptr<History>> histories_;
  std::map<size_t, int64_t> made_;  // Messages the node has made since the start, by stream.
  std::map<size_t, int64_t> recorded_at_start_;
};

}  // namespace nbs
