#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "common/bus/input_queues.h"
#include "common/bus/recorder.h"
#include "common/runtime/node.h"

namespace nbs {

/// How far a fold is.
struct FoldProgress {
  std::map<size_t, int64_t> processed;  ///< Messages folded in, by stream.
  int64_t utime_us = 0;                 ///< Of the last one.
  int64_t busy_us = 0;                  ///< Wall-clock time in the node's Handle.
  size_t needs = Node::kNoInput;  ///< The stream whose next message it waits for or works on; kNoInput before the first
                                  ///< and when finished.
  bool recovering = false;
  bool finished = false;
  std::string failure;  ///< Why it stopped; empty if it did not fail.
  std::vector<std::pair<std::string, int64_t>> complaints;
};

/// Runs a node: the thread that folds.
class Fold {
 public:
  /// @param on_output  Called from the folding thread when there is something to publish, and at the end.
  Fold(Node& node, Recorder& recorder, InputQueues& queues, std::function<void()> on_output);

  /// Starts the node and feeds it until it has finished, fails, or the queues are closed. Never throws: a failure shows
  /// in the progress.
  void Run();

  FoldProgress progress() const;

 private:
  bool Step();
  void Publish(Outbox out);
  template <typename Change>
  void Update(Change&& change);

  Node& node_;
  Recorder& recorder_;
  InputQueues& queues_;
  std::function<void()> on_output_;
  int64_t busy_ns_ = 0;
  mutable std::mutex mutex_;
  FoldProgress progress_;
};

}  // namespace nbs
