#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/runtime/run_failure.h"

namespace nbs {

/// One event of an LCM log.
struct LogEvent {
  int64_t offset = 0;       ///< Of the event's first byte in the file.
  int64_t data_offset = 0;  ///< Of the message's first byte in the file.
  int64_t number = 0;       ///< The log's own count of events; in a stream's history the message's number.
  int64_t timestamp_us = 0;
  std::string channel;
  std::vector<uint8_t> data;
};

/// A log whose bytes are not those of an LCM log. The text names the file, the byte and what is wrong there.
class LogDamage : public RunFailure {
 public:
  LogDamage(const std::filesystem::path& file, int64_t offset, bool torn, const std::string& what);

  int64_t offset() const { return offset_; }
  /// True if the file merely ends within an event that began well, as after a kill in mid-write.
  bool torn() const { return torn_; }

 private:
  int64_t offset_;
  bool torn_;
};

/// Bytes of one event in LCM's log format: sync word, number, timestamp, lengths (big-endian), channel, data.
std::vector<uint8_t> EncodeLogEvent(int64_t number, int64_t timestamp_us, std::string_view channel,
                                    std::span<const uint8_t> data);

/// Reads an LCM log from the beginning, checked: liblcm's own reader takes damage for the end of the file.
class LcmLogReader {
 public:
  /// @throws ConfigError if the file cannot be opened.
  explicit LcmLogReader(const std::filesystem::path& file);

  /// Reads the next event; false at the clean end.
  ///
  /// @throws LogDamage on a bad sync word, a length that no sender writes, or an end within an event.
  bool Next(LogEvent& event);

 private:
  bool ReadExactly(void* out, size_t bytes, int64_t event_offset, bool may_end);

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  int64_t offset_ = 0;
};

}  // namespace nbs
