#include "common/bus/window.h"

#include <algorithm>
#include <bit>

namespace nbs {
namespace {

constexpr size_t kDatagramHeaderBytes =
    400;  // IP, UDP and LCM headers, the channel's name, and the kernel's bookkeeping behind the data.
constexpr size_t kSocketBufferBytes = 320;     // The kernel's descriptor of the datagram.
constexpr size_t kLargestSingleBlock = 16384;  // Above, the kernel collects pages.
constexpr size_t kPagesSlack = 5120;

constexpr size_t kBulkWindow = 66000;   // One message of 60,000 B, or two of 30,000.
constexpr size_t kSmallWindow = 16500;  // Seven stripes of 224 points.

}  // namespace

size_t EstimateKernelBytes(size_t payload_bytes) {
  const size_t block = payload_bytes + kDatagramHeaderBytes;
  return block <= kLargestSingleBlock ? std::bit_ceil(block) + kSocketBufferBytes : payload_bytes + kPagesSlack;
}

size_t CalcWindowBytes(std::string_view service) {
  const bool bulk = service == "mesher" || service == "voxelmap" || service == "planner";
  return bulk ? kBulkWindow : kSmallWindow;
}

int64_t CalcCreditStep(int64_t window_bytes, int64_t largest_message_bytes) {
  constexpr int64_t kLeast = 4096;
  return std::max(kLeast, (window_bytes - largest_message_bytes) / 3);
}

}  // namespace nbs
