#pragma once

#include <cstddef>
#include <cstdint>

namespace nbs {

/// LCM's fingerprint of the stream's type: the first eight bytes of its messages.
///
/// @param stream  StreamOf<T>(), below the number of streams.
uint64_t FindFingerprint(size_t stream);

}  // namespace nbs
