#include "common/bus/history.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "common/bus/lcm_log.h"
#include "common/bus/window.h"
#include "common/runtime/error.h"

namespace nbs {

std::filesystem::path HistoryPath(const std::filesystem::path& run_folder, std::string_view channel) {
  return run_folder / "streams" / (std::string(channel) + ".lcm");
}

History::History(std::filesystem::path file, std::string channel, Access access)
    : path_(std::move(file)), channel_(std::move(channel)) {
  Open(access);
  try {
    end_offset_ = IndexEvents();
  } catch (...) {
    close(file_);
    throw;
  }
  if (access == Access::kAppend && ftruncate(file_, end_offset_) != 0 && errno != EINVAL) {
    const std::string reason = std::strerror(errno);
    close(file_);
    throw ConfigError("cannot cut the torn end of " + path_.string() + ": " + reason);
  }
}

History::~History() { close(file_); }

void History::Open(Access access) {
  const bool append = access == Access::kAppend;
  if (append) {
    std::error_code ignored;  // The open below tells what is wrong.
    std::filesystem::create_directories(path_.parent_path(), ignored);
  }
  file_ = open(path_.c_str(), append ? O_RDWR | O_CREAT | O_CLOEXEC : O_RDONLY | O_CLOEXEC, 0644);
  if (file_ < 0) throw ConfigError("cannot open the history " + path_.string() + ": " + std::strerror(errno));
  if (append && flock(file_, LOCK_EX | LOCK_NB) != 0) {
    close(file_);
    throw ConfigError("another process publishes " + channel_ + " for this run (" + path_.string() +
                      " is locked): stop it first");
  }
}

int64_t History::IndexEvents() {
  LcmLogReader reader(path_);
  LogEvent event;
  int64_t end = 0;
  try {
    while (reader.Next(event)) {
      if (event.channel != channel_)
        throw LogDamage(path_, event.offset, false, "an event of channel " + event.channel);
      if (event.number != static_cast<int64_t>(places_.size())) {
        throw LogDamage(
            path_, event.offset, false,
            "message " + std::to_string(event.number) + " where " + std::to_string(places_.size()) + " must stand");
      }
      AddPlace(event.data_offset, event.timestamp_us, event.data.size());
      end = event.data_offset + static_cast<int64_t>(event.data.size());
    }
  } catch (const LogDamage& damage) {
    if (!damage.torn()) throw;
  }
  return end;
}

void History::AddPlace(int64_t data_offset, int64_t utime_us, size_t data_bytes) {
  const std::lock_guard lock(mutex_);
  places_.push_back({data_offset, utime_us, kernel_bytes_, static_cast<uint32_t>(data_bytes)});
  kernel_bytes_ += static_cast<int64_t>(EstimateKernelBytes(data_bytes));
}

History::Place History::GetPlace(int64_t seq) const {
  const std::lock_guard lock(mutex_);
  return places_.at(static_cast<size_t>(seq));
}

int64_t History::size() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int64_t>(places_.size());
}

int64_t History::utime_us(int64_t seq) const { return GetPlace(seq).utime_us; }

int64_t History::CalcKernelBytesBefore(int64_t seq) const {
  const std::lock_guard lock(mutex_);
  return seq == static_cast<int64_t>(places_.size()) ? kernel_bytes_
                                                     : places_.at(static_cast<size_t>(seq)).kernel_bytes_before;
}

std::vector<uint8_t> History::Read(int64_t seq) const {
  const Place place = GetPlace(seq);
  std::vector<uint8_t> data(place.data_bytes);
  size_t done = 0;
  while (done < data.size()) {
    const ssize_t got =
        pread(file_, data.data() + done, data.size() - done, place.data_offset + static_cast<int64_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw RunFailure("cannot read message " + std::to_string(seq) + " of " + path_.string() + " again");
    done += static_cast<size_t>(got);
  }
  return data;
}

void History::Append(int64_t utime_us, std::span<const uint8_t> data) {
  const std::vector<uint8_t> event = EncodeLogEvent(size(), utime_us, channel_, data);
  ssize_t written;
  do {
    written = pwrite(file_, event.data(), event.size(), end_offset_);
  } while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(event.size())) {
    const std::string reason = written < 0 ? std::strerror(errno) : "no space left on device";
    if (ftruncate(file_, end_offset_) != 0) { /* The torn tail is cut at the next start. */
    }
    throw RunFailure("cannot write message " + std::to_string(size()) + " to " + path_.string() + ": " + reason +
                     "; free some space and start again");
  }
  AddPlace(end_offset_ + static_cast<int64_t>(event.size() - data.size()), utime_us, data.size());
  end_offset_ += static_cast<int64_t>(event.size());
}

}  // namespace nbs
