#pragma once

#include <cstdint>
#include <optional>

#include "common/bus/flight.h"

namespace nbs {

/// Lets simulated time run with the wall clock: says when a message of a given utime may go out.
///
/// Where the wall clock is ahead by more than 100 ms (the robot stood still while a scan was planned) the pace starts
/// anew, so that nothing is made up for in a rush.
class Pacer {
 public:
  /// When the message may go out; not later than `now` means at once. @pre utime_us does not fall from call to call.
  Instant CalcDue(int64_t utime_us, Instant now);

 private:
  struct Anchor {
    Instant wall;
    int64_t utime_us;
  };
  std::optional<Anchor> anchor_;
};

}  // namespace nbs
