#include <gtest/gtest.h>

#include "tests/common/messages/random_message.h"

namespace nbs {
namespace {

TEST(Header, IsReadFromEveryStreamWithTheMessagesTime) {
  std::mt19937_64 random(1);
  for (size_t stream = 0; stream < std::variant_size_v<Message>; ++stream) {
    const Message message = MakeRandomMessage(stream, random);
    const auto header = DecodeHeader(Encode({-5, 1LL << 40, 0, "mesher"}, message));
    ASSERT_TRUE(header.has_value());
    EXPECT_EQ(header->run, -5);
    EXPECT_EQ(header->seq, 1LL << 40);
    EXPECT_EQ(header->source, "mesher");
    EXPECT_EQ(header->utime_us, CalcUtime(message));
  }
}

TEST(Header, IsNotFoundInFewerBytesThanItTakes) {
  const auto bytes = Encode({1, 2, 0, "mesher"}, PlanRequest{});
  const size_t header_bytes = 8 + 3 * 8 + 4 + 7;
  for (size_t length = 0; length < header_bytes; ++length)
    EXPECT_FALSE(DecodeHeader(std::span(bytes).first(length)).has_value());
  EXPECT_TRUE(DecodeHeader(std::span(bytes).first(header_bytes)).has_value());
}

TEST(Header, IsNotFoundWhereTheSourcesLengthIsALie) {
  const auto bytes = Encode({1, 2, 0, "mesher"}, PlanRequest{});
  for (const int32_t lie : {0, -1, 6, 1000, 0x7fffffff}) {
    auto changed = bytes;
    for (size_t i = 0; i < 4; ++i) changed[32 + i] = static_cast<uint8_t>(static_cast<uint32_t>(lie) >> (24 - 8 * i));
    EXPECT_FALSE(DecodeHeader(changed).has_value()) << lie;
  }
}

}  // namespace
}  // namespace nbs
