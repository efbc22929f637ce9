#include "common/messages/fields.h"
#include "common/messages/translate.h"
#include "common/messages/wire.h"

namespace nbs {

std::optional<MessageHeader> DecodeHeader(std::span<const uint8_t> data) {
  WireReader wire(data);
  (void)wire.Fingerprint();
  MessageHeader header;
  Fields(wire, header);
  if (!wire.refusal().empty()) return std::nullopt;
  return header;
}

}  // namespace nbs
