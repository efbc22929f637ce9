#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace nbs {

/// Vertices that wait until the sensor has moved on.
class LagQueue {
 public:
  /// How far the sensor has come.
  struct Moment {
    double path_m = 0.0;
    int64_t stripes = 0;
  };

  void Push(uint32_t id, const Moment& now) { entries_.push_back({now, id}); }

  /// Moves out what has waited for `lag_m` of the path or for `lag_stripes`, in ascending order of the numbers.
  void TakeDue(const Moment& now, double lag_m, int64_t lag_stripes, std::vector<uint32_t>& ids);

  /// Moves out everything, likewise.
  void TakeAll(std::vector<uint32_t>& ids);

 private:
  struct Entry {
    Moment moment;
    uint32_t id = 0;
  };
  std::deque<Entry> entries_;
};

}  // namespace nbs
