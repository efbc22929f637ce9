#include "common/bus/input_stream.h"

#include <algorithm>

#include "common/messages/translate.h"
#include "common/messages/wiring.h"
#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

constexpr std::chrono::milliseconds kGapAge{2};       // Younger gaps may be datagrams that overtook each other.
constexpr std::chrono::milliseconds kAnswerTime{15};  // Silence after which a request counts as lost.
constexpr int64_t kFurthestAhead = int64_t{1} << 20;  // No honest sender's window reaches further.
constexpr int kMostRefusals = 10;

}  // namespace

InputStream::InputStream(size_t stream, int64_t run) : stream_(stream), run_(run) {
  const StreamWiring& wiring = Wiring()[stream];
  status_.channel = wiring.channel;
  status_.sender = wiring.sender;
}

void InputStream::Refuse(int64_t seq, const std::string& why) {
  ++status_.refused;
  if (seq != status_.received || !asked_.contains(seq)) return;
  if (++next_refused_ < kMostRefusals) return;
  throw RunFailure("message " + std::to_string(seq) + " on " + status_.channel + " from " + status_.sender +
                   " cannot be read: " + why);
}

void InputStream::OnDatagram(std::span<const uint8_t> data, Instant now, std::vector<Message>& in_order) {
  const std::optional<MessageHeader> header = DecodeHeader(data);
  if (!header || header->run != run_ || header->source != status_.sender || header->seq < 0) {
    ++status_.refused;
    return;
  }
  const int64_t seq = header->seq;
  NoteArrival(seq, now);
  if (seq < status_.received || early_.contains(seq)) {
    ++status_.duplicates;
    return;
  }
  if (seq > status_.received + kFurthestAhead) return Refuse(seq, "its number is far beyond the end");
  Decoded decoded = Decode(stream_, data);
  if (!decoded.message) return Refuse(seq, decoded.refusal);
  asked_.erase(seq);
  early_.emplace(seq, std::move(*decoded.message));
  TakeInOrder(in_order);
}

void InputStream::NoteArrival(int64_t seq, Instant now) {
  last_arrival_ = now;
  const auto arrived = asked_.find(seq);
  if (arrived == asked_.end()) return;
  // Answers come in the order of the request on one socket: what was asked for before it and has not come is lost.
  for (auto it = asked_.begin(); it != arrived; ++it) {
    if (it->second.request <= arrived->second.request) it->second.lost = true;
  }
}

void InputStream::TakeInOrder(std::vector<Message>& in_order) {
  while (!early_.empty() && early_.begin()->first == status_.received) {
    in_order.push_back(std::move(early_.begin()->second));
    early_.erase(early_.begin());
    ++status_.received;
    next_refused_ = 0;
  }
}

void InputStream::OnAnnouncedEnd(int64_t end) {
  status_.heard = true;
  announced_end_ = end;
}

int64_t InputStream::FindKnownEnd() const {
  return early_.empty() ? announced_end_ : std::max(announced_end_, early_.rbegin()->first + 1);
}

std::vector<int64_t> InputStream::TakeNumbersToAsk(Instant now) {
  if (!HasMissing()) {
    missing_since_.reset();
    asked_.clear();
    return {};
  }
  if (!missing_since_) {
    missing_since_ = now;
    ++status_.gaps;
  }
  if (now - *missing_since_ < kGapAge) return {};
  if (now - std::max(last_arrival_, last_request_) > kAnswerTime) asked_.clear();
  const auto open = std::ranges::count_if(asked_, [](const auto& entry) { return !entry.second.lost; });
  if (open > static_cast<std::ptrdiff_t>(kMaxRepairNumbers)) return {};

  std::vector<int64_t> numbers;
  const int64_t end = FindKnownEnd();
  auto early = early_.begin();
  for (int64_t seq = status_.received; seq < end && numbers.size() < kMaxRepairNumbers; ++seq) {
    while (early != early_.end() && early->first < seq) ++early;
    if (early != early_.end() && early->first == seq) continue;
    const auto asked = asked_.find(seq);
    if (asked == asked_.end() || asked->second.lost) numbers.push_back(seq);
  }
  if (numbers.empty()) return numbers;
  for (const int64_t seq : numbers) asked_[seq] = {requests_, false};
  ++requests_;
  status_.repairs += static_cast<int64_t>(numbers.size());
  last_request_ = now;
  return numbers;
}

}  // namespace nbs
