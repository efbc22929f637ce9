#pragma once

#include <cstdint>
#include <vector>

namespace nbs {

/// The encoded messages of one stream, by number. Safe to read from one thread while another appends.
class MessageStore {
 public:
  virtual ~MessageStore() = default;

  /// Messages 0 … size() - 1 are there.
  virtual int64_t size() const = 0;

  /// The encoded message. @pre 0 <= seq < size(). @throws RunFailure if it cannot be read.
  virtual std::vector<uint8_t> Read(int64_t seq) const = 0;

  /// Simulated time of a message. @pre 0 <= seq < size().
  virtual int64_t utime_us(int64_t seq) const = 0;

  /// Estimated kernel memory of messages 0 … seq - 1 when all lie in a receive buffer (window.h). @pre 0 <= seq <=
  /// size().
  virtual int64_t CalcKernelBytesBefore(int64_t seq) const = 0;
};

}  // namespace nbs
