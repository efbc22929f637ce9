#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/bus/transport.h"
#include "common/bus/wake_event.h"

namespace nbs {

/// The URL that a process joins: the given one, else LCM_DEFAULT_URL, else LCM's default group kept on this host
/// (ttl=0); for udpm with a request for a large receive buffer, which a stock machine grants only in part.
std::string ResolveLcmUrl(const std::string& url);

/// The bus proper: LCM, untyped. Its C interface, because a failed subscription of the C++ one crashes when it is used.
class LcmTransport : public Transport {
 public:
  /// @throws ConfigError, in one sentence with the remedy, if the bus cannot be opened.
  explicit LcmTransport(const std::string& url);
  ~LcmTransport() override;

  void Subscribe(const std::string& channel) override;
  void Publish(std::string_view channel, std::span<const uint8_t> data) override;
  void Poll(std::chrono::microseconds timeout, const Handler& handler) override;
  void Wake() override { wake_.Set(); }

 private:
  struct Datagram {
    std::string channel;
    std::vector<uint8_t> data;
  };
  struct Lcm;

  std::string url_;
  WakeEvent wake_;
  std::vector<Datagram> inbox_;
  std::unique_ptr<Lcm> lcm_;
};

}  // namespace nbs
