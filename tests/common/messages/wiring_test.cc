#include "common/messages/wiring.h"

#include <gtest/gtest.h>

#include <set>

namespace nbs {
namespace {

TEST(Wiring, ListsEveryStreamAtItsNumber) {
  ASSERT_EQ(Wiring().size(), std::variant_size_v<Message>);
  for (size_t n = 0; n < Wiring().size(); ++n) EXPECT_EQ(Wiring()[n].stream, n);
}

TEST(Wiring, GivesEveryStreamAChannelAndATypeOfItsOwn) {
  std::set<std::string_view> channels;
  std::set<std::string_view> types;
  for (const StreamWiring& wiring : Wiring()) {
    EXPECT_TRUE(channels.insert(wiring.channel).second) << wiring.channel;
    EXPECT_TRUE(types.insert(wiring.type).second) << wiring.type;
    EXPECT_FALSE(wiring.receivers.empty()) << wiring.channel;
  }
}

}  // namespace
}  // namespace nbs
