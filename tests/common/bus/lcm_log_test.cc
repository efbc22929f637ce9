#include "common/bus/lcm_log.h"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <fstream>

#include "common/runtime/error.h"
#include "tests/common/bus/test_service.h"

namespace nbs {
namespace {

class LcmLog : public testing::Test {
 private:
  TemporaryFolder folder_;

 protected:
  std::filesystem::path file_ = folder_.path() / "test.lcm";
  void Write(const std::vector<uint8_t>& bytes) {
    std::ofstream(file_, std::ios::binary | std::ios::app)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
};

const std::vector<uint8_t> kData = {1, 2, 3, 250};

TEST_F(LcmLog, ReadsBackWhatItWrote) {
  Write(EncodeLogEvent(3, 4000, "STRIPE", kData));
  Write(EncodeLogEvent(4, -1, "MESH", {}));
  LcmLogReader reader(file_);
  LogEvent event;
  ASSERT_TRUE(reader.Next(event));
  EXPECT_EQ(event.number, 3);
  EXPECT_EQ(event.timestamp_us, 4000);
  EXPECT_EQ(event.channel, "STRIPE");
  EXPECT_EQ(event.data, kData);
  EXPECT_EQ(event.data_offset, 28 + 6);
  ASSERT_TRUE(reader.Next(event));
  EXPECT_EQ(event.timestamp_us, -1);
  EXPECT_TRUE(event.data.empty());
  EXPECT_FALSE(reader.Next(event));
}

TEST_F(LcmLog, IsReadByLiblcm) {
  Write(EncodeLogEvent(0, 4000, "STRIPE", kData));
  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "r");
  ASSERT_NE(log, nullptr);
  lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log);
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->timestamp, 4000);
  EXPECT_STREQ(event->channel, "STRIPE");
  const auto* data = static_cast<const uint8_t*>(event->data);
  EXPECT_EQ(std::vector<uint8_t>(data, data + event->datalen), kData);
  lcm_eventlog_free_event(event);
  lcm_eventlog_destroy(log);
}

TEST_F(LcmLog, ReadsWhatLiblcmWrote) {
  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "w");
  std::string channel = "STRIPE";
  std::vector<uint8_t> data = kData;
  lcm_eventlog_event_t event{0, 4000, 6, 4, channel.data(), data.data()};
  ASSERT_EQ(lcm_eventlog_write_event(log, &event), 0);
  lcm_eventlog_destroy(log);
  LogEvent read;
  ASSERT_TRUE(LcmLogReader(file_).Next(read));
  EXPECT_EQ(read.channel, "STRIPE");
  EXPECT_EQ(read.data, kData);
}

TEST_F(LcmLog, NamesTheByteOfABadSyncWord) {
  Write(EncodeLogEvent(0, 0, "STRIPE", kData));
  std::vector<uint8_t> damaged = EncodeLogEvent(1, 0, "STRIPE", kData);
  damaged[0] ^= 1;
  Write(damaged);
  LcmLogReader reader(file_);
  LogEvent event;
  ASSERT_TRUE(reader.Next(event));
  try {
    reader.Next(event);
    FAIL() << "the damage was not seen";
  } catch (const LogDamage& damage) {
    EXPECT_EQ(damage.offset(), 38);
    EXPECT_FALSE(damage.torn());
    EXPECT_EQ(std::string(damage.what()), file_.string() + " is damaged at byte 38: bad sync word");
  }
}

TEST_F(LcmLog, TellsATornEventAtEveryLength) {
  const std::vector<uint8_t> whole = EncodeLogEvent(0, 0, "STRIPE", kData);
  for (size_t length = 1; length < whole.size(); ++length) {
    std::filesystem::remove(file_);
    Write({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)});
    LcmLogReader reader(file_);
    LogEvent event;
    try {
      reader.Next(event);
      ADD_FAILURE() << "not seen at " << length;
    } catch (const LogDamage& damage) {
      EXPECT_TRUE(damage.torn()) << length;
    }
  }
}

TEST_F(LcmLog, RefusesImpossibleLengthsWithoutAllocating) {
  std::vector<uint8_t> event = EncodeLogEvent(0, 0, "STRIPE", kData);
  event[24] = 0x7f;
  Write(event);
  LcmLogReader reader(file_);
  LogEvent read;
  EXPECT_THROW(reader.Next(read), LogDamage);
}

TEST_F(LcmLog, ThatIsMissingIsBadInput) { EXPECT_THROW(LcmLogReader("/nowhere/bus.lcm"), ConfigError); }

}  // namespace
}  // namespace nbs
