#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace nbs {

/// Writes LCM's wire format: big-endian numbers, IEEE floating point, strings with length and a closing zero byte,
/// arrays element by element.
class WireWriter {
 public:
  static constexpr bool kReads = false;

  /// An integer that travels as type W.
  ///
  /// @throws std::out_of_range (through Overflow) if the value does not fit W.
  template <std::integral W, std::integral T>
  void Integer(const T& value) {
    if (!std::in_range<W>(value)) Overflow();
    Put(static_cast<std::make_unsigned_t<W>>(static_cast<W>(value)));
  }
  template <typename E>
  void Enum(const E& value, int /*values*/) {
    Put(static_cast<uint8_t>(value));
  }
  void Bool(bool value) { Put(static_cast<uint8_t>(value)); }
  void Float(float value) { Put(std::bit_cast<uint32_t>(value)); }
  void Double(double value) { Put(std::bit_cast<uint64_t>(value)); }
  void String(const std::string& value);
  void Fingerprint(uint64_t value) { Put(value); }

  /// The count in front of an array (or of several of equal length).
  size_t Count(size_t count) {
    Integer<int32_t>(count);
    return count;
  }
  /// The elements of an array whose count has been written.
  template <typename T, typename Function>
  void Elements(const std::vector<T>& elements, size_t /*count*/, Function&& each) {
    for (const T& element : elements) each(element);
  }

  std::vector<uint8_t> TakeBytes() { return std::move(bytes_); }

 private:
  template <std::unsigned_integral U>
  void Put(U value) {
    std::array<uint8_t, sizeof(U)> big_endian;
    for (size_t i = 0; i < sizeof(U); ++i) big_endian[i] = static_cast<uint8_t>(value >> (8 * (sizeof(U) - 1 - i)));
    bytes_.insert(bytes_.end(), big_endian.begin(), big_endian.end());
  }
  [[noreturn]] static void Overflow();

  std::vector<uint8_t> bytes_;
};

/// Reads the same format from bytes that are not trusted: it never reads past the end, never allocates for more
/// elements than there are bytes left, and refuses what a WireWriter would not have written (a truth value of 2, an
/// enumeration's code out of range, a string without its end).
///
/// After the first refusal every read gives zero or empty; the caller looks at refusal() once, at the end.
class WireReader {
 public:
  static constexpr bool kReads = true;

  explicit WireReader(std::span<const uint8_t> data) : data_(data) {}

  template <std::integral W, std::integral T>
  void Integer(T& value) {
    const auto wire = static_cast<W>(Get<std::make_unsigned_t<W>>());
    if (!std::in_range<T>(wire)) return Refuse("a number is out of range");
    value = static_cast<T>(wire);
  }
  template <typename E>
  void Enum(E& value, int values) {
    const auto code = Get<uint8_t>();
    if (code >= values) return Refuse("unknown code " + std::to_string(code));
    value = static_cast<E>(code);
  }
  void Bool(bool& value) {
    const auto byte = Get<uint8_t>();
    if (byte > 1) return Refuse("a truth value is neither 0 nor 1");
    value = byte == 1;
  }
  void Float(float& value) { value = std::bit_cast<float>(Get<uint32_t>()); }
  void Double(double& value) { value = std::bit_cast<double>(Get<uint64_t>()); }
  void String(std::string& value);
  uint64_t Fingerprint() { return Get<uint64_t>(); }

  /// The count in front of an array; the argument is ignored. No element takes less than a byte, so that a larger count
  /// than there are bytes is refused.
  size_t Count(size_t /*unused*/);
  template <typename T, typename Function>
  void Elements(std::vector<T>& elements, size_t count, Function&& each) {
    elements.assign(count, T{});
    for (size_t i = 0; i < count && refusal_.empty(); ++i) each(elements[i]);
  }

  size_t remaining() const { return data_.size() - position_; }
  const std::string& refusal() const { return refusal_; }
  void Refuse(std::string why);

 private:
  template <std::unsigned_integral U>
  U Get() {
    if (remaining() < sizeof(U)) {
      Refuse("it is cut off");
      return 0;
    }
    U value = 0;
    for (size_t i = 0; i < sizeof(U); ++i) {
      value = static_cast<U>(value | static_cast<U>(static_cast<U>(data_[position_ + i]) << (8 * (sizeof(U) - 1 - i))));
    }
    position_ += sizeof(U);
    return value;
  }

  std::span<const uint8_t> data_;
  size_t position_ = 0;
  std::string refusal_;
};

}  // namespace nbs
