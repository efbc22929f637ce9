#pragma once

#include <cstdint>

namespace nbs {

/// The instants at which the profiler can take a profile: tick k is at k / rate, rounded to a microsecond.
class ProfileClock {
 public:
  /// @param rate_hz  Ticks a second, > 0 and at most 1e6.
  /// @throws std::invalid_argument if the rate is out of that range.
  explicit ProfileClock(double rate_hz);

  /// Time of tick `tick`, microseconds since the start of the run.
  int64_t CalcTime(int64_t tick) const;

  /// The first tick at or after `utime_us` (>= 0).
  int64_t FindTick(int64_t utime_us) const;

 private:
  double period_us_;
};

}  // namespace nbs
