#include <utility>

#include "common/messages/check.h"
#include "common/messages/fields.h"
#include "common/messages/fingerprint.h"
#include "common/messages/translate.h"
#include "common/messages/wire.h"

namespace nbs {
namespace {

template <typename T>
Decoded DecodeAs(std::span<const uint8_t> data) {
  WireReader wire(data);
  if (wire.Fingerprint() != FindFingerprint(StreamOf<T>())) wire.Refuse("its fingerprint is that of another type");
  MessageHeader header;
  Fields(wire, header);
  if (header.seq < 0) wire.Refuse("its number is negative");
  T message{};
  Fields(wire, message);
  if (wire.remaining() > 0) wire.Refuse("bytes are left over");
  if (!wire.refusal().empty()) return {std::nullopt, wire.refusal()};
  message.utime_us = header.utime_us;
  Message checked = std::move(message);
  std::string fault = FindFault(checked);
  if (!fault.empty()) return {std::nullopt, std::move(fault)};
  return {std::move(checked), {}};
}

template <size_t... Streams>
Decoded Dispatch(size_t stream, std::span<const uint8_t> data, std::index_sequence<Streams...>) {
  Decoded decoded{std::nullopt, "there is no stream " + std::to_string(stream)};
  (void)((stream == Streams && (decoded = DecodeAs<std::variant_alternative_t<Streams, Message>>(data), true)) || ...);
  return decoded;
}

}  // namespace

Decoded Decode(size_t stream, std::span<const uint8_t> data) {
  return Dispatch(stream, data, std::make_index_sequence<std::variant_size_v<Message>>());
}

}  // namespace nbs
