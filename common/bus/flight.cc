#include "common/bus/flight.h"

#include <algorithm>

namespace nbs {

void FlightLedger::Add(Flight flight) {
  total_ += flight.kernel_bytes;
  peak_ = std::max(peak_, total_);
  flights_.push_back(std::move(flight));
}

void FlightLedger::Retire(const std::function<bool(const Flight&)>& has_landed) {
  std::erase_if(flights_, [&](const Flight& flight) {
    const bool landed = has_landed(flight);
    if (landed) total_ -= flight.kernel_bytes;
    return landed;
  });
}

}  // namespace nbs
