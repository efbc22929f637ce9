#include "common/bus/merge.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "common/bus/history.h"
#include "common/bus/lcm_log.h"
#include "common/messages/wiring.h"
#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

struct Source {
  std::string name;
  std::unique_ptr<History> history;
};

std::string FindSender(const std::string& channel) {
  for (const StreamWiring& wiring : Wiring()) {
    if (wiring.channel == channel) return std::string(wiring.sender);
  }
  return channel;
}

std::vector<Source> OpenHistories(const std::filesystem::path& streams_folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& folder : {streams_folder, streams_folder / "status"}) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".lcm") files.push_back(entry.path());
    }
  }
  std::vector<Source> sources;
  for (const auto& file : files) {
    const std::string channel = file.stem().string();
    sources.push_back({FindSender(channel), std::make_unique<History>(file, channel, History::Access::kRead)});
  }
  std::ranges::sort(sources, {}, [](const Source& s) { return std::tuple(s.name, s.history->channel()); });
  return sources;
}

struct Entry {
  int64_t utime_us;
  size_t source;
  int64_t seq;
};

std::vector<Entry> OrderEntries(const std::vector<Source>& sources) {
  std::vector<Entry> entries;
  for (size_t i = 0; i < sources.size(); ++i) {
    for (int64_t seq = 0; seq < sources[i].history->size(); ++seq) {
      entries.push_back({sources[i].history->utime_us(seq), i, seq});
    }
  }
  std::ranges::sort(entries, {}, [&](const Entry& e) {
    return std::tuple(e.utime_us, std::string_view(sources[e.source].name), e.seq, e.source);
  });
  return entries;
}

class LogFile {
 public:
  explicit LogFile(const std::filesystem::path& path)
      : path_(path), file_(std::fopen(path.c_str(), "wb"), &std::fclose) {
    if (!file_) Fail();
  }
  void Write(const std::vector<uint8_t>& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) Fail();
  }
  void Close() {
    if (std::fclose(file_.release()) != 0) Fail();
  }

 private:
  [[noreturn]] void Fail() const {
    throw RunFailure("cannot write the log " + path_.string() + ": " + std::strerror(errno));
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

int64_t MergeHistories(const std::filesystem::path& streams_folder, const std::filesystem::path& out_file) {
  const std::vector<Source> sources = OpenHistories(streams_folder);
  const std::vector<Entry> entries = OrderEntries(sources);
  std::filesystem::path unfinished = out_file;
  unfinished += ".tmp";
  LogFile log(unfinished);
  int64_t number = 0;
  for (const Entry& entry : entries) {
    const History& history = *sources[entry.source].history;
    log.Write(EncodeLogEvent(number++, entry.utime_us, history.channel(), history.Read(entry.seq)));
  }
  log.Close();
  std::error_code error;
  std::filesystem::rename(unfinished, out_file, error);
  if (error) throw RunFailure("cannot write the log " + out_file.string() + ": " + error.message());
  return number;
}

}  // namespace nbs
