#include "common/bus/heartbeat.h"

namespace nbs {
namespace {

constexpr std::chrono::milliseconds kMovingPeriod{10};
constexpr std::chrono::milliseconds kIdlePeriod{200};

}  // namespace

void HeartbeatClock::NoteSent(Instant now) {
  moved_ = false;
  hurry_ = false;
  last_ = now;
}

Instant HeartbeatClock::CalcDue() const {
  if (hurry_) return last_;
  return last_ + (moved_ ? kMovingPeriod : kIdlePeriod);
}

}  // namespace nbs
