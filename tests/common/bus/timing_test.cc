#include <gtest/gtest.h>

#include "common/bus/heartbeat.h"
#include "common/bus/pacer.h"
#include "common/bus/peers.h"
#include "common/bus/window.h"

namespace nbs {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Instant kStart = Clock::now();

TEST(Pacer, AddsSimulatedTimeToTheFirstMoment) {
  Pacer pacer;
  EXPECT_EQ(pacer.CalcDue(1000000, kStart), kStart);
  EXPECT_EQ(pacer.CalcDue(1040000, kStart + milliseconds(10)), kStart + milliseconds(40));
}

TEST(Pacer, StartsAnewAfterAPause) {
  Pacer pacer;
  pacer.CalcDue(0, kStart);
  const Instant later = kStart + seconds(5);
  EXPECT_EQ(pacer.CalcDue(40000, later), later);
  EXPECT_EQ(pacer.CalcDue(80000, later), later + milliseconds(40));
}

TEST(Heartbeat, ComesFiveTimesASecondWhenNothingMoves) {
  HeartbeatClock clock;
  clock.NoteSent(kStart);
  EXPECT_FALSE(clock.IsDue(kStart + milliseconds(199)));
  EXPECT_TRUE(clock.IsDue(kStart + milliseconds(200)));
}

TEST(Heartbeat, ComesAfterTenMillisecondsWhenSomethingMoves) {
  HeartbeatClock clock;
  clock.NoteSent(kStart);
  clock.NoteMoved();
  EXPECT_FALSE(clock.IsDue(kStart + milliseconds(9)));
  EXPECT_TRUE(clock.IsDue(kStart + milliseconds(10)));
}

TEST(Heartbeat, ComesAtOnceWhenSomebodyWaitsForCredit) {
  HeartbeatClock clock;
  clock.NoteSent(kStart);
  clock.NoteHurry();
  EXPECT_TRUE(clock.IsDue(kStart));
}

ServiceStatus WaitingForStripes() {
  ServiceStatus status;
  status.waits_for = "STRIPE from sensor";
  status.inputs.resize(1);
  status.inputs[0].channel = "STRIPE";
  status.inputs[0].sender = "sensor";
  return status;
}

TEST(Peers, NameASenderThatHasNotBeenHeard) {
  Peers peers(kStart);
  EXPECT_EQ(peers.FindLate(WaitingForStripes(), kStart + seconds(2)), "");
  EXPECT_EQ(peers.FindLate(WaitingForStripes(), kStart + seconds(4)),
            "waiting for sensor, which sends STRIPE and has not been heard for 3 s");
  EXPECT_EQ(peers.FindLate(WaitingForStripes(), kStart + seconds(5)), "") << "it repeats itself at once";
}

TEST(Peers, DoNotNameASenderThatIsMerelyBusy) {
  Peers peers(kStart);
  ServiceStatus sensor;
  sensor.service = "sensor";
  peers.NoteHeard(sensor, kStart + seconds(3));
  EXPECT_EQ(peers.FindLate(WaitingForStripes(), kStart + seconds(4)), "");
}

TEST(Peers, NameTheReceiverThatHoldsTheWindow) {
  Peers peers(kStart);
  ServiceStatus status;
  status.outputs.resize(1);
  status.outputs[0].channel = "STRIPE";
  status.outputs[0].waits_for = "voxelmap";
  EXPECT_EQ(peers.FindLate(status, kStart + seconds(4)),
            "waiting for voxelmap, which receives STRIPE and has not been heard for 3 s");
}

TEST(Peers, TellANewProcessFromOneThatIsKnown) {
  Peers peers(kStart);
  ServiceStatus sensor;
  sensor.service = "sensor";
  sensor.pid = 1;
  EXPECT_TRUE(peers.NoteHeard(sensor, kStart));
  EXPECT_FALSE(peers.NoteHeard(sensor, kStart));
  sensor.pid = 2;
  EXPECT_TRUE(peers.NoteHeard(sensor, kStart));
}

TEST(Window, OfAllWhoTalkAtOnceFitsAStockReceiveBuffer) {
  constexpr size_t kHeartbeats = 9 * 1344;
  size_t scanning = kHeartbeats;
  for (const char* service : {"robot", "simulator", "sensor", "mesher", "voxelmap"})
    scanning += CalcWindowBytes(service);
  EXPECT_LE(scanning, kStockReceiveBuffer);
  EXPECT_LE(CalcWindowBytes("planner") + CalcWindowBytes("coordinator") + kHeartbeats, kStockReceiveBuffer);
}

TEST(Window, GetsCreditBeforeTheNextMessageMeetsItsEnd) {
  for (const int64_t window : {16500, 66000}) {
    for (const int64_t message : {1344, 2368, 37000, 65000}) {
      if (message > window) continue;
      // What a receiver may keep back is less than one step and one message, unless a single message fills the window.
      EXPECT_LE(CalcCreditStep(window, message) + message, std::max(window, message + 4096))
          << window << " " << message;
    }
  }
}

TEST(Window, TakesAMessageOfTheLargestSize) { EXPECT_LE(EstimateKernelBytes(60000), CalcWindowBytes("mesher")); }

}  // namespace
}  // namespace nbs
