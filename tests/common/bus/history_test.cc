#include "common/bus/history.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "common/bus/lcm_log.h"
#include "common/bus/window.h"
#include "common/runtime/error.h"
#include "tests/common/bus/test_service.h"

namespace nbs {
namespace {

class HistoryFile : public testing::Test {
 protected:
  History Open(History::Access access = History::Access::kAppend) { return {file_, "STRIPE", access}; }
  std::vector<uint8_t> Data(int64_t seq) const {
    return std::vector<uint8_t>(static_cast<size_t>(10 + seq), static_cast<uint8_t>(seq));
  }
  void Fill(int count) {
    History history = Open();
    for (int64_t seq = history.size(); seq < count; ++seq) history.Append(100 * seq, Data(seq));
  }
  void ExpectWhole(const History& history, int64_t count) {
    ASSERT_EQ(history.size(), count);
    for (int64_t seq = 0; seq < count; ++seq) {
      EXPECT_EQ(history.Read(seq), Data(seq));
      EXPECT_EQ(history.utime_us(seq), 100 * seq);
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = HistoryPath(folder_.path(), "STRIPE");
};

TEST_F(HistoryFile, ReadsBackByNumber) {
  History history = Open();
  for (int64_t seq = 0; seq < 20; ++seq) history.Append(100 * seq, Data(seq));
  ExpectWhole(history, 20);
}

TEST_F(HistoryFile, GoesOnWhereItEndedWhenOpenedAgain) {
  Fill(10);
  Fill(20);
  ExpectWhole(Open(), 20);
}

TEST_F(HistoryFile, CutsATornTailAtEveryByteAndGoesOn) {
  Fill(3);
  const auto whole = static_cast<int64_t>(std::filesystem::file_size(file_));
  Fill(4);
  const auto full = static_cast<int64_t>(std::filesystem::file_size(file_));
  for (int64_t length = whole; length < full; ++length) {
    std::filesystem::resize_file(file_, static_cast<uintmax_t>(length));
    ExpectWhole(Open(), 3);
    EXPECT_EQ(std::filesystem::file_size(file_), static_cast<uintmax_t>(whole));
    Fill(4);
    ExpectWhole(Open(), 4);
  }
}

TEST_F(HistoryFile, IsLeftAsItIsByAReader) {
  Fill(4);
  const auto full = std::filesystem::file_size(file_);
  std::filesystem::resize_file(file_, full - 1);
  ExpectWhole(Open(History::Access::kRead), 3);
  EXPECT_EQ(std::filesystem::file_size(file_), full - 1);
}

TEST_F(HistoryFile, ThatIsDamagedInTheMiddleIsRefused) {
  Fill(4);
  std::fstream file(file_, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(28 + 6 + 10);
  file.put('x');
  file.close();
  EXPECT_THROW(Open(), LogDamage);
}

TEST_F(HistoryFile, ThatLacksAMessageIsRefused) {
  std::filesystem::create_directories(file_.parent_path());
  const std::vector<uint8_t> event = EncodeLogEvent(1, 0, "STRIPE", Data(1));
  std::ofstream(file_, std::ios::binary)
      .write(reinterpret_cast<const char*>(event.data()), static_cast<std::streamsize>(event.size()));
  EXPECT_THROW(Open(), LogDamage);
}

TEST_F(HistoryFile, IsLockedAgainstASecondWriter) {
  const History first = Open();
  EXPECT_THROW(Open(), ConfigError);
  EXPECT_NO_THROW(Open(History::Access::kRead));
}

TEST_F(HistoryFile, SaysThatTheDiskIsFullAndStaysWhole) {
  Fill(3);
  History history = Open();
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit before = [] {
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    return limit;
  }();
  rlimit full = before;
  full.rlim_cur = std::filesystem::file_size(file_) + 20;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  std::string sentence;
  try {
    history.Append(300, Data(3));
  } catch (const RunFailure& failure) {
    sentence = failure.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(sentence, "cannot write message 3 to " + file_.string() +
                          ": no space left on device; free some space and start again");
  ExpectWhole(history, 3);
  history.Append(300, Data(3));
  ExpectWhole(history, 4);
}

TEST_F(HistoryFile, SumsTheKernelMemoryOfItsMessages) {
  Fill(3);
  const History history = Open();
  EXPECT_EQ(history.CalcKernelBytesBefore(0), 0);
  EXPECT_EQ(history.CalcKernelBytesBefore(3),
            static_cast<int64_t>(EstimateKernelBytes(10) + EstimateKernelBytes(11) + EstimateKernelBytes(12)));
}

}  // namespace
}  // namespace nbs
