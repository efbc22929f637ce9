#include "common/bus/status.h"

#include <gtest/gtest.h>

#include "common/runtime/counter_random.h"
#include "nbs_msgs/repair_request_t.hpp"
#include "nbs_msgs/service_status_t.hpp"

namespace nbs {
namespace {

ServiceStatus MakeStatus() {
  ServiceStatus status{3, 12, 40000, 777, "mesher", 4711, ServiceState::kReady, "STRIPE from sensor", {}, {}, {}};
  status.inputs.push_back({"STRIPE", "sensor", true, 9, 8, 1, 2, 3, 4});
  status.outputs.push_back({"MESH", 5, 7, 4, 66000, 2, 1, "planner"});
  status.outputs.push_back({"MESH_SCAN", 1, 1, 1, 66000, 0, 0, ""});
  status.complaints = {{"stripe twice", 2}};
  return status;
}

TEST(ServiceStatus, SurvivesTheWire) { EXPECT_EQ(DecodeStatus(EncodeStatus(MakeStatus())), MakeStatus()); }

TEST(ServiceStatus, IsReadByTheGeneratedType) {
  const std::vector<uint8_t> data = EncodeStatus(MakeStatus());
  nbs_msgs::service_status_t generated{};
  ASSERT_EQ(generated.decode(data.data(), 0, static_cast<int>(data.size())), static_cast<int>(data.size()));
  EXPECT_EQ(generated.service, "mesher");
  EXPECT_TRUE(generated.state == nbs_msgs::service_status_t::READY);
  EXPECT_EQ(generated.input_received, std::vector<int64_t>{9});
  EXPECT_EQ(generated.output_channel, (std::vector<std::string>{"MESH", "MESH_SCAN"}));
  EXPECT_EQ(generated.output_waits_for[0], "planner");
  EXPECT_EQ(generated.complaint_count, std::vector<int64_t>{2});
}

TEST(ServiceStatus, ThatIsCutOffIsRefused) {
  const std::vector<uint8_t> data = EncodeStatus(MakeStatus());
  for (size_t length = 0; length < data.size(); ++length) {
    EXPECT_FALSE(DecodeStatus(std::span(data).first(length))) << length;
  }
}

TEST(ServiceStatus, WithAChangedByteNeverCrashes) {
  const std::vector<uint8_t> data = EncodeStatus(MakeStatus());
  for (uint64_t i = 0; i < 20000; ++i) {
    std::vector<uint8_t> changed = data;
    changed[CalcRandomBits({1, i}) % data.size()] = static_cast<uint8_t>(CalcRandomBits({2, i}));
    (void)DecodeStatus(changed);
  }
}

TEST(ServiceStatus, WithACountBelowZeroIsRefused) {
  ServiceStatus status = MakeStatus();
  status.inputs[0].received = -1;
  EXPECT_FALSE(DecodeStatus(EncodeStatus(status)));
}

TEST(RepairRequest, SurvivesTheWire) {
  const RepairRequest request{3, "mesher", "STRIPE", {4, 5, 9}};
  EXPECT_EQ(DecodeRepairRequest(EncodeRepairRequest(request)), request);
}

TEST(RepairRequest, IsReadByTheGeneratedType) {
  const std::vector<uint8_t> data = EncodeRepairRequest({3, "mesher", "STRIPE", {4, 5, 9}});
  nbs_msgs::repair_request_t generated{};
  ASSERT_EQ(generated.decode(data.data(), 0, static_cast<int>(data.size())), static_cast<int>(data.size()));
  EXPECT_EQ(generated.seqs, (std::vector<int64_t>{4, 5, 9}));
}

TEST(RepairRequest, ForMoreThanSixtyFourNumbersIsRefused) {
  RepairRequest request{3, "mesher", "STRIPE", std::vector<int64_t>(64)};
  EXPECT_TRUE(DecodeRepairRequest(EncodeRepairRequest(request)));
  request.seqs.resize(65);
  EXPECT_FALSE(DecodeRepairRequest(EncodeRepairRequest(request)));
}

}  // namespace
}  // namespace nbs
