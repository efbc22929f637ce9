#include "common/bus/status_record.h"

namespace nbs {
namespace {

std::filesystem::path FindFile(const std::filesystem::path& run_folder, const std::string& service) {
  return run_folder / "streams" / "status" / (StatusChannel(service) + ".lcm");
}

}  // namespace

StatusRecord::StatusRecord(const std::filesystem::path& run_folder, const std::string& service)
    : history_(FindFile(run_folder, service), StatusChannel(service), History::Access::kAppend) {}

void StatusRecord::Offer(const ServiceStatus& status, std::span<const uint8_t> encoded, Instant now) {
  constexpr std::chrono::seconds kPeriod{1};
  if (status.state == last_state_ && now - last_ < kPeriod) return;
  history_.Append(status.utime_us, encoded);
  last_ = now;
  last_state_ = status.state;
}

void StatusRecord::Close(const ServiceStatus& status, std::span<const uint8_t> encoded) {
  history_.Append(status.utime_us, encoded);
}

std::optional<double> ReadBusyTime(const std::filesystem::path& run_folder, const std::string& service) {
  const std::filesystem::path file = FindFile(run_folder, service);
  if (!std::filesystem::exists(file)) return std::nullopt;
  const History history(file, StatusChannel(service), History::Access::kRead);
  if (history.size() == 0) return std::nullopt;
  const std::optional<ServiceStatus> last = DecodeStatus(history.Read(history.size() - 1));
  return last ? std::optional(1e-6 * static_cast<double>(last->busy_us)) : std::nullopt;
}

}  // namespace nbs
