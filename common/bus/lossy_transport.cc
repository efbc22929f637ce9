#include "common/bus/lossy_transport.h"

#include "common/runtime/counter_random.h"

namespace nbs {

LossyTransport::LossyTransport(std::unique_ptr<Transport> inner, double drop, uint64_t seed)
    : inner_(std::move(inner)), drop_(drop), seed_(seed) {}

void LossyTransport::Poll(std::chrono::microseconds timeout, const Handler& handler) {
  inner_->Poll(timeout, [&](std::string_view channel, std::span<const uint8_t> data) {
    if (CalcUniform({seed_, count_++}) >= drop_) handler(channel, data);
  });
}

}  // namespace nbs
