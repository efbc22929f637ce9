#include "common/bus/log_store.h"

#include "common/bus/lcm_log.h"
#include "common/bus/window.h"
#include "common/messages/translate.h"
#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

struct Found {
  MessageHeader header;
  std::vector<uint8_t> data;
};
using FoundBySeq = std::map<int64_t, Found>;

std::string Name(const std::string& channel, int64_t seq) { return channel + " message " + std::to_string(seq); }

void Take(const std::filesystem::path& log, LogEvent& event, FoundBySeq& found) {
  const std::optional<MessageHeader> header = DecodeHeader(event.data);
  if (!header) throw LogDamage(log, event.offset, false, "the message on " + event.channel + " has no header");
  const auto known = found.find(header->seq);
  if (known == found.end()) {
    found.emplace(header->seq, Found{*header, std::move(event.data)});
  } else if (known->second.data != event.data) {
    throw RunFailure(Name(event.channel, header->seq) + " is twice in " + log.string() + ", with different bytes");
  }
}

}  // namespace

int64_t LogStore::CalcKernelBytesBefore(int64_t seq) const {
  return seq == size() ? kernel_bytes_ : At(seq).kernel_bytes_before;
}

void LogStore::Add(const std::vector<uint8_t>& data, int64_t utime_us) {
  messages_.push_back({data, utime_us, kernel_bytes_});
  kernel_bytes_ += static_cast<int64_t>(EstimateKernelBytes(data.size()));
}

std::map<std::string, LogStore> ReadLogStores(const std::filesystem::path& log, const std::set<std::string>& channels) {
  std::map<std::string, FoundBySeq> found;
  LcmLogReader reader(log);
  LogEvent event;
  while (reader.Next(event)) {
    if (channels.contains(event.channel)) Take(log, event, found[event.channel]);
  }
  std::map<std::string, LogStore> stores;
  for (const std::string& channel : channels) {
    LogStore& store = stores[channel];
    if (!found.contains(channel)) continue;
    store.run_ = found[channel].begin()->second.header.run;
    for (const auto& [seq, message] : found[channel]) {
      if (seq != store.size()) throw RunFailure(Name(channel, store.size()) + " is missing in " + log.string());
      store.Add(message.data, message.header.utime_us);
    }
  }
  return stores;
}

}  // namespace nbs
