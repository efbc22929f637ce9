#include "common/bus/pacer.h"

namespace nbs {

Instant Pacer::CalcDue(int64_t utime_us, Instant now) {
  constexpr std::chrono::milliseconds kMostBehind{100};
  if (!anchor_) anchor_ = Anchor{now, utime_us};
  const Instant due = anchor_->wall + std::chrono::microseconds(utime_us - anchor_->utime_us);
  if (now - due <= kMostBehind) return due;
  anchor_ = Anchor{now, utime_us};
  return now;
}

}  // namespace nbs
