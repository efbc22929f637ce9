#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/runtime/node.h"

namespace nbs {

/// The header of a stream message (lcmtypes/header_t.lcm).
struct MessageHeader {
  int64_t run = 0;
  int64_t seq = 0;
  int64_t utime_us = 0;
  std::string source;
};

/// Largest encoded message on a stream, bytes: one datagram on every network that LCM runs on.
inline constexpr size_t kMaxMessageBytes = 60000;

/// Cuts a message into several of the same type that each encode to at most kMaxMessageBytes and mean the same when
/// handled one after the other (end_of_scan and end only on the last). Most messages come back alone and unchanged.
///
/// @throws std::invalid_argument if a message that cannot be cut is too large.
std::vector<Message> SplitForBus(Message message);

/// Simulated time of a message (its utime_us).
int64_t CalcUtime(const Message& message);

/// Encodes for the message's channel: LCM fingerprint, header, payload. header.utime_us is taken from the message.
std::vector<uint8_t> Encode(const MessageHeader& header, const Message& message);

/// Reads only the header, without trusting any length in the data; nullopt if the data cannot hold one.
std::optional<MessageHeader> DecodeHeader(std::span<const uint8_t> data);

/// Decodes a message of the given stream, checked: wrong fingerprint, lengths that do not fit the data, values no
/// sender would send (not finite, enum out of range, a rotation that is none) come back as a refusal in words, never as
/// an exception or a crash.
struct Decoded {
  std::optional<Message> message;
  std::string refusal;
};
Decoded Decode(size_t stream, std::span<const uint8_t> data);

}  // namespace nbs
