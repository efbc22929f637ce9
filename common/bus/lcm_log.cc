#include "common/bus/lcm_log.h"

#include <cstring>

#include "common/bus/big_endian.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr uint32_t kSyncWord = 0xEDA1DA01u;
constexpr size_t kEventHeaderBytes = 28;
constexpr int32_t kMaxChannelBytes = 63;      // LCM's own limit.
constexpr int32_t kMaxDataBytes = 256 << 20;  // More than LCM can send in fragments.

}  // namespace

LogDamage::LogDamage(const std::filesystem::path& file, int64_t offset, bool torn, const std::string& what)
    : RunFailure(file.string() + " is damaged at byte " + std::to_string(offset) + ": " + what),
      offset_(offset),
      torn_(torn) {}

std::vector<uint8_t> EncodeLogEvent(int64_t number, int64_t timestamp_us, std::string_view channel,
                                    std::span<const uint8_t> data) {
  std::vector<uint8_t> bytes(kEventHeaderBytes + channel.size() + data.size());
  uint8_t* p = bytes.data();
  p = PutBigEndian(p, kSyncWord);
  p = PutBigEndian(p, static_cast<uint64_t>(number));
  p = PutBigEndian(p, static_cast<uint64_t>(timestamp_us));
  p = PutBigEndian(p, static_cast<uint32_t>(channel.size()));
  p = PutBigEndian(p, static_cast<uint32_t>(data.size()));
  std::memcpy(p, channel.data(), channel.size());
  if (!data.empty()) std::memcpy(p + channel.size(), data.data(), data.size());
  return bytes;
}

LcmLogReader::LcmLogReader(const std::filesystem::path& file)
    : path_(file), file_(std::fopen(file.c_str(), "rb"), &std::fclose) {
  if (!file_) throw ConfigError("cannot open the log " + file.string() + ": " + std::strerror(errno));
  std::setvbuf(file_.get(), nullptr, _IOFBF, 1 << 20);
}

bool LcmLogReader::ReadExactly(void* out, size_t bytes, int64_t event_offset, bool may_end) {
  const size_t got = std::fread(out, 1, bytes, file_.get());
  offset_ += static_cast<int64_t>(got);
  if (got == bytes) return true;
  if (got == 0 && may_end) return false;
  throw LogDamage(path_, event_offset, true, "the file ends within an event");
}

bool LcmLogReader::Next(LogEvent& event) {
  const int64_t begin = offset_;
  uint8_t header[kEventHeaderBytes];
  // The sync word is read alone, so that a wrong one is told from a torn event.
  if (!ReadExactly(header, 4, begin, true)) return false;
  if (GetBigEndian<uint32_t>(header) != kSyncWord) throw LogDamage(path_, begin, false, "bad sync word");
  ReadExactly(header + 4, kEventHeaderBytes - 4, begin, false);
  const auto channel_bytes = static_cast<int32_t>(GetBigEndian<uint32_t>(header + 20));
  const auto data_bytes = static_cast<int32_t>(GetBigEndian<uint32_t>(header + 24));
  if (channel_bytes < 1 || channel_bytes > kMaxChannelBytes || data_bytes < 0 || data_bytes > kMaxDataBytes) {
    throw LogDamage(path_, begin, false, "impossible length");
  }
  event.offset = begin;
  event.number = static_cast<int64_t>(GetBigEndian<uint64_t>(header + 4));
  event.timestamp_us = static_cast<int64_t>(GetBigEndian<uint64_t>(header + 12));
  event.channel.resize(static_cast<size_t>(channel_bytes));
  ReadExactly(event.channel.data(), event.channel.size(), begin, false);
  event.data_offset = offset_;
  event.data.resize(static_cast<size_t>(data_bytes));
  ReadExactly(event.data.data(), event.data.size(), begin, event.data.empty());
  return true;
}

}  // namespace nbs
