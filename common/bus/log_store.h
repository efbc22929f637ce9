#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "common/bus/message_store.h"

namespace nbs {

/// The messages of one stream in a recorded log, in memory, by number.
class LogStore : public MessageStore {
 public:
  int64_t size() const override { return static_cast<int64_t>(messages_.size()); }
  std::vector<uint8_t> Read(int64_t seq) const override { return At(seq).data; }
  int64_t utime_us(int64_t seq) const override { return At(seq).utime_us; }
  int64_t CalcKernelBytesBefore(int64_t seq) const override;

  /// The run that the first message belongs to; 0 if there is none.
  int64_t run() const { return run_; }

 private:
  friend std::map<std::string, LogStore> ReadLogStores(const std::filesystem::path& log,
                                                       const std::set<std::string>& channels);
  struct Recorded {
    std::vector<uint8_t> data;
    int64_t utime_us;
    int64_t kernel_bytes_before;
  };

  const Recorded& At(int64_t seq) const { return messages_.at(static_cast<size_t>(seq)); }
  void Add(const std::vector<uint8_t>& data, int64_t utime_us);

  std::vector<Recorded> messages_;
  int64_t kernel_bytes_ = 0;
  int64_t run_ = 0;
};

/// Reads streams from a log. Messages are put in order of their numbers; one that comes again must be equal. A channel
/// that the log does not have gives an empty store.
///
/// @throws ConfigError if the log cannot be opened; LogDamage if it is damaged; RunFailure, naming channel and number,
/// if a message is missing or comes
///         twice with different bytes.
std::map<std::string, LogStore> ReadLogStores(const std::filesystem::path& log, const std::set<std::string>& channels);

}  // namespace nbs
