#include "common/bus/status_record.h"

namespace nbs {

StatusRecord::StatusRecord(const std::filesystem::path& run_folder, const std::string& service)
    : history_(run_folder / "streams" / "status" / (StatusChannel(service) + ".lcm"), StatusChannel(service),
               History::Access::kAppend) {}

void StatusRecord::Offer(const ServiceStatus& status, std::span<const uint8_t> encoded, Instant now) {
  constexpr std::chrono::seconds kPeriod{1};
  if (status.state == last_state_ && now - last_ < kPeriod) return;
  history_.Append(status.utime_us, encoded);
  last_ = now;
  last_state_ = status.state;
}

}  // namespace nbs
