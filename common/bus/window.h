#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace nbs {

/// Receive buffer of a socket on a stock Linux machine (net.core.rmem_default), bytes of kernel memory.
inline constexpr size_t kStockReceiveBuffer = 212992;

/// Kernel memory that one datagram with a payload of that many bytes takes in a receive buffer: what counts there is
/// the size of the block that holds the datagram and its bookkeeping, not its length. An upper estimate, measured on
/// Linux 6 (README.md).
size_t EstimateKernelBytes(size_t payload_bytes);

/// The credit window of a service, bytes of kernel memory: what it may have on its way at any time, live messages of
/// all its streams and repair together.
///
/// Every process on the bus's port receives every datagram, so it is the sum over the services that must fit
/// kStockReceiveBuffer. Mesher and voxelmap talk at the same time as robot, simulator and sensor; planner and
/// coordinator talk while those are silent. One message of the largest size may always go alone.
size_t CalcWindowBytes(std::string_view service);

/// Received bytes after which a receiver gives credit at once: early enough that the next message of the largest size
/// seen still finds room in the sender's window.
int64_t CalcCreditStep(int64_t window_bytes, int64_t largest_message_bytes);

}  // namespace nbs
