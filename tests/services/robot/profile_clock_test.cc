#include "services/robot/profile_clock.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nbs {
namespace {

TEST(ProfileClock, TicksEvery40MillisecondsAt25Hz) {
  const ProfileClock clock(25.0);
  EXPECT_EQ(clock.CalcTime(0), 0);
  EXPECT_EQ(clock.CalcTime(3), 120'000);
}

TEST(ProfileClock, DoesNotDriftAtARateWithoutWholePeriods) {
  EXPECT_EQ(ProfileClock(30.0).CalcTime(30 * 3600), 3'600'000'000);
}

TEST(ProfileClock, FindsTheFirstTickAtOrAfterATime) {
  const ProfileClock clock(25.0);
  EXPECT_EQ(clock.FindTick(0), 0);
  EXPECT_EQ(clock.FindTick(1), 1);
  EXPECT_EQ(clock.FindTick(40'000), 1);
  EXPECT_EQ(clock.FindTick(40'001), 2);
}

TEST(ProfileClock, FindsEveryTickAtItsOwnTime) {
  for (const double rate_hz : {25.0, 30.0, 200.0, 7.3}) {
    const ProfileClock clock(rate_hz);
    for (int64_t tick = 0; tick < 5000; tick += 7) {
      EXPECT_EQ(clock.FindTick(clock.CalcTime(tick)), tick);
      EXPECT_EQ(clock.FindTick(clock.CalcTime(tick) + 1), tick + 1);
    }
  }
}

TEST(ProfileClock, ARateThatIsNotPositiveThrows) {
  EXPECT_THROW(ProfileClock(0.0), std::invalid_argument);
  EXPECT_THROW(ProfileClock(-25.0), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
