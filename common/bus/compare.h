#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace nbs {

/// How one channel of a recorded log compares with the history that another run made.
struct ChannelComparison {
  std::string channel;
  int64_t recorded = 0;    ///< Messages of the log.
  int64_t made = 0;        ///< Messages of the history.
  int64_t identical = 0;   ///< Messages that are equal in all bytes, up to the first difference.
  std::string difference;  ///< The first difference in words, with number and byte; empty if there is none.
};

/// Whether a recorded run came to its end: its last RUN_STATE says so. True as well if the log has none that can be
/// read. A run that was cut short has inputs in its log that nobody had answered yet.
///
/// @throws as CompareChannel.
bool CameToItsEnd(const std::filesystem::path& log);

/// Compares the messages of a channel in a log with those of the history streams_folder/CHANNEL.lcm, byte for byte,
/// header included. Messages that the log holds more than once (recorded while they were repaired) must be equal each
/// time. A missing history has no messages.
///
/// @param ended  False: messages that were made beyond the recorded ones are no difference.
/// @throws ConfigError if the log is missing; LogDamage if one of them is damaged.
ChannelComparison CompareChannel(const std::filesystem::path& log, const std::filesystem::path& streams_folder,
                                 const std::string& channel, bool ended = true);

}  // namespace nbs
