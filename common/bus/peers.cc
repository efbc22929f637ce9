#include "common/bus/peers.h"

namespace nbs {
namespace {

constexpr std::chrono::seconds kSilence{3};
constexpr std::chrono::seconds kNamingPeriod{10};

}  // namespace

bool Peers::NoteHeard(const ServiceStatus& status, Instant now) {
  const auto known = peers_.find(status.service);
  const bool is_new = known == peers_.end() || known->second.pid != status.pid;
  peers_[status.service] = {status.pid, now};
  return is_new;
}

bool Peers::IsSilent(const std::string& service, Instant now) const {
  const auto known = peers_.find(service);
  return now - (known == peers_.end() ? since_ : known->second.heard) > kSilence;
}

std::string Peers::FindLate(const ServiceStatus& status, Instant now) {
  if (now - last_named_ < kNamingPeriod && last_named_ != since_) return {};
  std::string sentence;
  for (const OutputStatus& output : status.outputs) {
    if (output.waits_for.empty() || !IsSilent(output.waits_for, now)) continue;
    sentence = "waiting for " + output.waits_for + ", which receives " + output.channel + " and has not been heard";
  }
  for (const InputStatus& input : status.inputs) {
    if (status.waits_for != input.channel + " from " + input.sender || !IsSilent(input.sender, now)) continue;
    sentence = "waiting for " + input.sender + ", which sends " + input.channel + " and has not been heard";
  }
  if (sentence.empty()) return {};
  last_named_ = now;
  return sentence + " for " + std::to_string(kSilence.count()) + " s";
}

}  // namespace nbs
