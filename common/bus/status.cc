#include "common/bus/status.h"

#include <algorithm>

#include "common/messages/wire.h"
#include "nbs_msgs/repair_request_t.hpp"
#include "nbs_msgs/service_status_t.hpp"

namespace nbs {
namespace {

constexpr int kStates = 4;

// The same walk over the fields writes and reads; Struct is const when writing. The rows of a table travel column by
// column, the first of which makes the rows.

template <typename Wire, typename Rows, typename Field>
void Column(Wire& wire, Rows& rows, Field&& field) {
  for (auto& row : rows) field(wire, row);
}

template <typename Wire, typename Status>
void InputColumns(Wire& wire, Status& status) {
  const size_t count = wire.Count(status.inputs.size());
  wire.Elements(status.inputs, count, [&](auto& row) { wire.String(row.channel); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.String(row.sender); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.Bool(row.heard); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.received); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.processed); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.gaps); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.repairs); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.duplicates); });
  Column(wire, status.inputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.refused); });
}

template <typename Wire, typename Status>
void OutputColumns(Wire& wire, Status& status) {
  const size_t count = wire.Count(status.outputs.size());
  wire.Elements(status.outputs, count, [&](auto& row) { wire.String(row.channel); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.published); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.recorded); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.acknowledged); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.window); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.stalls); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.template Integer<int64_t>(row.repaired); });
  Column(wire, status.outputs, [](auto& w, auto& row) { w.String(row.waits_for); });
}

template <typename Wire, typename Status>
void StatusFields(Wire& wire, Status& status) {
  wire.template Integer<int64_t>(status.run);
  wire.template Integer<int64_t>(status.number);
  wire.template Integer<int64_t>(status.utime_us);
  wire.template Integer<int64_t>(status.busy_us);
  wire.String(status.service);
  wire.template Integer<int32_t>(status.pid);
  wire.Enum(status.state, kStates);
  wire.String(status.waits_for);
  InputColumns(wire, status);
  OutputColumns(wire, status);
  const size_t count = wire.Count(status.complaints.size());
  wire.Elements(status.complaints, count, [&](auto& row) { wire.String(row.first); });
  Column(wire, status.complaints, [](auto& w, auto& row) { w.template Integer<int64_t>(row.second); });
}

template <typename Wire, typename Request>
void RequestFields(Wire& wire, Request& request) {
  wire.template Integer<int64_t>(request.run);
  wire.String(request.service);
  wire.String(request.channel);
  const size_t count = wire.Count(request.seqs.size());
  wire.Elements(request.seqs, count, [&](auto& seq) { wire.template Integer<int64_t>(seq); });
}

bool IsWhole(const WireReader& wire) { return wire.refusal().empty() && wire.remaining() == 0; }

bool HasNegative(const ServiceStatus& status) {
  const auto bad_input = [](const InputStatus& s) { return s.received < 0 || s.processed < 0; };
  const auto bad_output = [](const OutputStatus& s) {
    return s.published < 0 || s.recorded < 0 || s.acknowledged < 0 || s.window < 0;
  };
  return std::ranges::any_of(status.inputs, bad_input) || std::ranges::any_of(status.outputs, bad_output);
}

}  // namespace

std::string_view ToString(ServiceState state) {
  switch (state) {
    case ServiceState::kStarting:
      return "starting";
    case ServiceState::kRecovering:
      return "recovering";
    case ServiceState::kReady:
      return "ready";
    case ServiceState::kFinished:
      return "finished";
  }
  return "unknown";
}

std::string StatusChannel(std::string_view service) { return "STATUS_" + std::string(service); }

std::vector<uint8_t> EncodeStatus(const ServiceStatus& status) {
  WireWriter wire;
  wire.Fingerprint(static_cast<uint64_t>(nbs_msgs::service_status_t::getHash()));
  StatusFields(wire, status);
  return wire.TakeBytes();
}

std::vector<uint8_t> EncodeRepairRequest(const RepairRequest& request) {
  WireWriter wire;
  wire.Fingerprint(static_cast<uint64_t>(nbs_msgs::repair_request_t::getHash()));
  RequestFields(wire, request);
  return wire.TakeBytes();
}

std::optional<ServiceStatus> DecodeStatus(std::span<const uint8_t> data) {
  WireReader wire(data);
  if (wire.Fingerprint() != static_cast<uint64_t>(nbs_msgs::service_status_t::getHash())) return std::nullopt;
  ServiceStatus status;
  StatusFields(wire, status);
  if (!IsWhole(wire) || HasNegative(status)) return std::nullopt;
  return status;
}

std::optional<RepairRequest> DecodeRepairRequest(std::span<const uint8_t> data) {
  WireReader wire(data);
  if (wire.Fingerprint() != static_cast<uint64_t>(nbs_msgs::repair_request_t::getHash())) return std::nullopt;
  RepairRequest request;
  RequestFields(wire, request);
  if (!IsWhole(wire) || request.seqs.size() > kMaxRepairNumbers) return std::nullopt;
  return request;
}

}  // namespace nbs
