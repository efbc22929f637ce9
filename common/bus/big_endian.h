#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace nbs {

/// Writes an unsigned number, highest byte first, as LCM does on the wire and in its logs; returns the place behind it.
template <typename Unsigned>
uint8_t* PutBigEndian(uint8_t* out, Unsigned value) {
  static_assert(std::is_unsigned_v<Unsigned>);
  for (size_t i = 0; i < sizeof(Unsigned); ++i)
    out[i] = static_cast<uint8_t>(value >> (8 * (sizeof(Unsigned) - 1 - i)));
  return out + sizeof(Unsigned);
}

/// Reads an unsigned number, highest byte first. @pre `in` holds sizeof(Unsigned) bytes.
template <typename Unsigned>
Unsigned GetBigEndian(const uint8_t* in) {
  static_assert(std::is_unsigned_v<Unsigned>);
  Unsigned value = 0;
  for (size_t i = 0; i < sizeof(Unsigned); ++i) value = static_cast<Unsigned>((value << 8) | in[i]);
  return value;
}

}  // namespace nbs
