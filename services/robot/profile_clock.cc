#include "services/robot/profile_clock.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {

ProfileClock::ProfileClock(double rate_hz) : period_us_(1e6 / rate_hz) {
  if (!(rate_hz > 0.0 && rate_hz <= 1e6))
    throw std::invalid_argument("ProfileClock: no rate of " + std::to_string(rate_hz) + " Hz");
}

int64_t ProfileClock::CalcTime(int64_t tick) const { return std::llround(static_cast<double>(tick) * period_us_); }

int64_t ProfileClock::FindTick(int64_t utime_us) const {
  auto tick = static_cast<int64_t>(static_cast<double>(utime_us) / period_us_);
  while (tick > 0 && CalcTime(tick - 1) >= utime_us) --tick;
  while (CalcTime(tick) < utime_us) ++tick;
  return tick;
}

}  // namespace nbs
