#include "common/bus/input_stream.h"

#include <gtest/gtest.h>

#include "common/bus/offline.h"
#include "common/messages/translate.h"
#include "common/runtime/counter_random.h"
#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

using std::chrono::milliseconds;

class StripeInput : public testing::Test {
 protected:
  std::vector<uint8_t> Stripe(int64_t seq, int64_t run = 7, const std::string& source = "sensor") const {
    nbs::Stripe stripe;
    stripe.utime_us = 40000 * seq;
    stripe.ranges_m = {0.3f, 0.0f};
    return Encode({run, seq, stripe.utime_us, source}, stripe);
  }
  // Takes datagrams; returns the numbers that are now in order.
  std::vector<int64_t> Take(const std::vector<int64_t>& seqs) {
    std::vector<Message> in_order;
    for (const int64_t seq : seqs) input_.OnDatagram(Stripe(seq), now_, in_order);
    std::vector<int64_t> numbers;
    for (const Message& message : in_order) numbers.push_back(CalcUtime(message) / 40000);
    return numbers;
  }
  void TakeRaw(const std::vector<uint8_t>& data) {
    std::vector<Message> in_order;
    input_.OnDatagram(data, now_, in_order);
    EXPECT_TRUE(in_order.empty());
  }
  std::vector<int64_t> AskAfter(milliseconds time) {
    now_ += time;
    return input_.TakeNumbersToAsk(now_);
  }

  InputStream input_{StreamOf<nbs::Stripe>(), 7};
  Instant now_ = Clock::now();
};

using Numbers = std::vector<int64_t>;

TEST_F(StripeInput, PutsMessagesInOrder) {
  EXPECT_EQ(Take({0, 2, 3}), Numbers{0});
  EXPECT_EQ(Take({1}), (Numbers{1, 2, 3}));
  EXPECT_EQ(input_.status().received, 4);
}

TEST_F(StripeInput, DropsDuplicates) {
  Take({0, 2, 2, 0});
  EXPECT_EQ(input_.status().duplicates, 2);
  EXPECT_EQ(Take({1}), (Numbers{1, 2}));
}

TEST_F(StripeInput, AsksForAGapWhenItIsAFewMillisecondsOld) {
  Take({0, 2, 5});
  EXPECT_EQ(AskAfter(milliseconds(0)), Numbers{});
  EXPECT_EQ(AskAfter(milliseconds(1)), Numbers{});
  EXPECT_EQ(AskAfter(milliseconds(1)), (Numbers{1, 3, 4}));
  EXPECT_EQ(input_.status().gaps, 1);
  EXPECT_EQ(input_.status().repairs, 3);
}

TEST_F(StripeInput, AsksForALostTailBelowTheAnnouncedEnd) {
  Take({0});
  EXPECT_EQ(AskAfter(milliseconds(100)), Numbers{});
  input_.OnAnnouncedEnd(3);
  AskAfter(milliseconds(0));
  EXPECT_EQ(AskAfter(milliseconds(2)), (Numbers{1, 2}));
}

TEST_F(StripeInput, DoesNotAskForAGapThatClosesByItself) {
  Take({0, 2});
  AskAfter(milliseconds(0));
  Take({1});
  EXPECT_EQ(AskAfter(milliseconds(50)), Numbers{});
}

TEST_F(StripeInput, AsksForAtMostSixtyFourNumbersAndTwoRequestsAtATime) {
  input_.OnAnnouncedEnd(1000);
  AskAfter(milliseconds(0));
  const Numbers first = AskAfter(milliseconds(2));
  const Numbers second = AskAfter(milliseconds(0));
  ASSERT_EQ(first.size(), 64u);
  ASSERT_EQ(second.size(), 64u);
  EXPECT_EQ(second.front(), 64);
  EXPECT_EQ(AskAfter(milliseconds(0)), Numbers{});
  Take(first);
  EXPECT_EQ(AskAfter(milliseconds(0)).front(), 128);
}

TEST_F(StripeInput, AsksAgainAtOnceWhenALaterAnswerShowsThatOneWasLost) {
  input_.OnAnnouncedEnd(3);
  AskAfter(milliseconds(0));
  EXPECT_EQ(AskAfter(milliseconds(2)), (Numbers{0, 1, 2}));
  Take({1});
  EXPECT_EQ(AskAfter(milliseconds(0)), Numbers{0});
}

TEST_F(StripeInput, AsksAgainWhenTheRequestItselfWasLost) {
  input_.OnAnnouncedEnd(2);
  AskAfter(milliseconds(0));
  EXPECT_EQ(AskAfter(milliseconds(2)), (Numbers{0, 1}));
  EXPECT_EQ(AskAfter(milliseconds(10)), Numbers{});
  EXPECT_EQ(AskAfter(milliseconds(6)), (Numbers{0, 1}));
}

TEST_F(StripeInput, RefusesMessagesOfAnotherRun) {
  TakeRaw(Stripe(0, 8));
  EXPECT_EQ(input_.status().refused, 1);
  EXPECT_EQ(input_.status().received, 0);
}

TEST_F(StripeInput, RefusesMessagesOfAnotherSender) {
  TakeRaw(Stripe(0, 7, "mesher"));
  EXPECT_EQ(input_.status().refused, 1);
}

TEST_F(StripeInput, RefusesADamagedMessageAndTakesItWhenItComesWhole) {
  std::vector<uint8_t> damaged = Stripe(0);
  damaged.resize(damaged.size() - 3);
  TakeRaw(damaged);
  EXPECT_EQ(input_.status().refused, 1);
  EXPECT_EQ(Take({0}), Numbers{0});
}

TEST_F(StripeInput, RefusesANumberThatNoSenderHasReached) {
  TakeRaw(Stripe(int64_t{1} << 40));
  EXPECT_EQ(input_.status().refused, 1);
  EXPECT_EQ(AskAfter(milliseconds(10)), Numbers{});
}

TEST_F(StripeInput, SurvivesAnyChangedByte) {
  const std::vector<uint8_t> data = Stripe(5);
  std::vector<Message> in_order;
  for (uint64_t i = 0; i < 20000; ++i) {
    std::vector<uint8_t> changed = data;
    changed[CalcRandomBits({3, i}) % data.size()] = static_cast<uint8_t>(CalcRandomBits({4, i}));
    input_.OnDatagram(changed, now_, in_order);
  }
  EXPECT_GT(input_.status().refused, 0);
}

TEST_F(StripeInput, FailsWithASentenceWhenTheSenderOnlyEverSendsItDamaged) {
  std::vector<uint8_t> damaged = Stripe(0);
  damaged.push_back(0);
  input_.OnAnnouncedEnd(1);
  AskAfter(milliseconds(0));
  const auto try_often = [&] {
    for (int i = 0; i < 20; ++i) {
      AskAfter(milliseconds(20));
      TakeRaw(damaged);
    }
  };
  EXPECT_THROW(try_often(), RunFailure);
}

}  // namespace
}  // namespace nbs
