#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace nbs {

/// Carries datagrams between processes, without any promise: they may be lost. All but Wake belongs to one thread.
class Transport {
 public:
  using Handler = std::function<void(std::string_view channel, std::span<const uint8_t> data)>;
  virtual ~Transport() = default;

  /// From now on, datagrams of exactly this channel reach the handler of Poll. @throws ConfigError if the bus cannot be
  /// joined.
  virtual void Subscribe(const std::string& channel) = 0;

  virtual void Publish(std::string_view channel, std::span<const uint8_t> data) = 0;

  /// Hands what has arrived to the handler, in order of arrival; waits for at most that long if nothing has. Returns
  /// early on Wake and on a signal. The handler may publish.
  virtual void Poll(std::chrono::microseconds timeout, const Handler& handler) = 0;

  /// Ends the waiting of Poll, now or the next time. Safe from any thread and from a signal handler.
  virtual void Wake() = 0;
};

}  // namespace nbs
