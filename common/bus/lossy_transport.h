#pragma once

#include <cstdint>
#include <memory>

#include "common/bus/transport.h"

namespace nbs {

/// Loses a share of the datagrams that arrive, for tests: the n-th one is dropped or not by a hash of (seed, n).
class LossyTransport : public Transport {
 public:
  /// @param drop  Share that is lost, 0 … 1.
  LossyTransport(std::unique_ptr<Transport> inner, double drop, uint64_t seed);

  void Subscribe(const std::string& channel) override { inner_->Subscribe(channel); }
  void Publish(std::string_view channel, std::span<const uint8_t> data) override { inner_->Publish(channel, data); }
  void Poll(std::chrono::microseconds timeout, const Handler& handler) override;
  void Wake() override { inner_->Wake(); }

 private:
  std::unique_ptr<Transport> inner_;
  double drop_;
  uint64_t seed_;
  uint64_t count_ = 0;
};

}  // namespace nbs
