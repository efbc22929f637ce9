#pragma once

#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/message_store.h"

namespace nbs {

/// Path of the history of a channel below the run folder: RUN/streams/CHANNEL.lcm.
std::filesystem::path HistoryPath(const std::filesystem::path& run_folder, std::string_view channel);

/// What a stream has published so far, in a file in LCM's log format: event number = the message's number, timestamp =
/// its utime.
///
/// Every message is appended by one write() before it goes out, so that a killed service finds all that anybody may
/// have seen. A tail torn by a kill in mid-write is cut off when the file is opened; any other damage is refused by
/// name.
class History : public MessageStore {
 public:
  enum class Access {
    kAppend,  ///< Creates the file if need be, and locks it against a second process of the same service.
    kRead,    ///< The file must exist; a torn tail is passed over and left as it is.
  };

  /// @throws ConfigError if the file cannot be opened, or another process has it open for appending.
  /// @throws LogDamage on damage other than a torn tail.
  History(std::filesystem::path file, std::string channel, Access access);
  ~History() override;
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  const std::string& channel() const { return channel_; }
  int64_t size() const override;
  std::vector<uint8_t> Read(int64_t seq) const override;
  int64_t utime_us(int64_t seq) const override;
  int64_t CalcKernelBytesBefore(int64_t seq) const override;

  /// Adds the next message, number size().
  ///
  /// @throws RunFailure if it cannot be written (disk full); the file is then as it was before.
  void Append(int64_t utime_us, std::span<const uint8_t> data);

 private:
  struct Place {
    int64_t data_offset;
    int64_t utime_us;
    int64_t kernel_bytes_before;
    uint32_t data_bytes;
  };

  void Open(Access access);
  int64_t IndexEvents();
  void AddPlace(int64_t data_offset, int64_t utime_us, size_t data_bytes);
  Place GetPlace(int64_t seq) const;

  std::filesystem::path path_;
  std::string channel_;
  int file_ = -1;
  int64_t end_offset_ = 0;
  int64_t kernel_bytes_ = 0;
  mutable std::mutex
      mutex_;  // Guards places_ and kernel_bytes_; the bytes in the file never change once their place is known.
  std::vector<Place> places_;
};

}  // namespace nbs
