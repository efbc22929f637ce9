#include "common/bus/compare.h"

#include <algorithm>
#include <optional>

#include "common/bus/history.h"
#include "common/bus/log_store.h"
#include "common/messages/translate.h"

namespace nbs {

bool CameToItsEnd(const std::filesystem::path& log) {
  const LogStore states = std::move(ReadLogStores(log, {"RUN_STATE"}).at("RUN_STATE"));
  if (states.size() == 0) return true;
  const Decoded last = Decode(StreamOf<RunState>(), states.Read(states.size() - 1));
  return !last.message || std::get<RunState>(*last.message).phase == RunPhase::kFinished;
}

ChannelComparison CompareChannel(const std::filesystem::path& log, const std::filesystem::path& streams_folder,
                                 const std::string& channel, bool ended) {
  const LogStore recorded = std::move(ReadLogStores(log, {channel}).at(channel));
  const std::filesystem::path file = streams_folder / (channel + ".lcm");
  std::optional<History> history;
  if (std::filesystem::exists(file)) history.emplace(file, channel, History::Access::kRead);
  const int64_t made = history ? history->size() : 0;
  ChannelComparison result{channel, recorded.size(), made, 0, {}};
  const auto at = [&](int64_t seq) { return channel + " message " + std::to_string(seq); };
  for (int64_t seq = 0; seq < std::min(recorded.size(), made); ++seq) {
    const std::vector<uint8_t> expected = recorded.Read(seq);
    const std::vector<uint8_t> actual = history->Read(seq);
    if (expected != actual) {
      const auto byte = std::ranges::mismatch(expected, actual).in1 - expected.begin();
      result.difference = at(seq) + " differs at byte " + std::to_string(byte) + " (" +
                          std::to_string(expected.size()) + " bytes recorded, " + std::to_string(actual.size()) +
                          " made)";
      return result;
    }
    ++result.identical;
  }
  if (made < recorded.size()) result.difference = at(made) + " was recorded but not made";
  if (made > recorded.size() && ended) result.difference = at(recorded.size()) + " was made but not recorded";
  return result;
}

}  // namespace nbs
