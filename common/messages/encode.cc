#include "common/messages/fields.h"
#include "common/messages/fingerprint.h"
#include "common/messages/translate.h"
#include "common/messages/wire.h"

namespace nbs {

int64_t CalcUtime(const Message& message) {
  return std::visit([](const auto& m) { return m.utime_us; }, message);
}

std::vector<uint8_t> Encode(const MessageHeader& header, const Message& message) {
  WireWriter wire;
  wire.Fingerprint(FindFingerprint(message.index()));
  MessageHeader stamped = header;
  stamped.utime_us = CalcUtime(message);
  Fields(wire, stamped);
  std::visit([&](const auto& m) { Fields(wire, m); }, message);
  return wire.TakeBytes();
}

}  // namespace nbs
