#include <algorithm>
#include <stdexcept>

#include "common/messages/check.h"
#include "common/messages/translate.h"
#include "common/messages/wiring.h"

namespace nbs {
namespace {

// What a message may take beside the elements of its arrays: fingerprint, header with a source of up to 64 bytes, plain
// fields, counts.
constexpr size_t kOverheadBytes = 200;
constexpr size_t kRoomBytes = kMaxMessageBytes - kOverheadBytes;
// Encoded sizes of array elements, bytes.
constexpr size_t kVertexBytes = 48;
constexpr size_t kTriangleBytes = 16;
constexpr size_t kRunBytes = 8;
constexpr size_t kValueBytes = 2;
constexpr size_t kCandidateBytes = 214;

// Moves over as many elements from `source`, beginning at `next`, as fit into `room` bytes, and takes their size from
// it.
template <typename T>
void Take(const std::vector<T>& source, size_t bytes_each, size_t& next, size_t& room, std::vector<T>& target) {
  const size_t count = std::min(source.size() - next, room / bytes_each);
  target.assign(source.begin() + static_cast<std::ptrdiff_t>(next),
                source.begin() + static_cast<std::ptrdiff_t>(next + count));
  next += count;
  room -= count * bytes_each;
}

std::vector<Message> Split(const MeshDelta& whole) {
  std::vector<Message> pieces;
  size_t vertex = 0;
  size_t triangle = 0;
  for (bool last = false; !last;) {
    MeshDelta piece{whole.utime_us, whole.scan, false, {}, {}};
    size_t room = kRoomBytes;
    Take(whole.vertices, kVertexBytes, vertex, room, piece.vertices);
    if (vertex == whole.vertices.size()) Take(whole.triangles, kTriangleBytes, triangle, room, piece.triangles);
    last = vertex == whole.vertices.size() && triangle == whole.triangles.size();
    piece.end_of_scan = last && whole.end_of_scan;
    pieces.emplace_back(std::move(piece));
  }
  return pieces;
}

// The next piece of a run that may have been begun before: at most what `room` holds.
size_t TakeRun(const VoxelDelta& whole, size_t run, size_t done, size_t first_value, size_t& room, VoxelDelta& piece) {
  const size_t count = std::min<size_t>(whole.run_length[run] - done, (room - kRunBytes) / kValueBytes);
  const auto values = whole.values.begin() + static_cast<std::ptrdiff_t>(first_value);
  piece.run_start.push_back(whole.run_start[run] + static_cast<uint32_t>(done));
  piece.run_length.push_back(static_cast<uint16_t>(count));
  piece.values.insert(piece.values.end(), values, values + static_cast<std::ptrdiff_t>(count));
  room -= kRunBytes + count * kValueBytes;
  return count;
}

std::vector<Message> Split(const VoxelDelta& whole) {
  std::vector<Message> pieces;
  size_t run = 0;
  size_t done = 0;  // Cells of `run` that are in earlier pieces.
  size_t value = 0;
  const std::string fault = FindFault(whole);
  if (!fault.empty()) throw std::invalid_argument("SplitForBus: " + fault);
  do {
    VoxelDelta piece{whole.utime_us, whole.scan, false, {}, {}, {}};
    for (size_t room = kRoomBytes; run < whole.run_start.size() && room >= kRunBytes + kValueBytes;) {
      const size_t count = TakeRun(whole, run, done, value, room, piece);
      value += count;
      done += count;
      if (done == whole.run_length[run]) ++run, done = 0;
    }
    piece.end_of_scan = run == whole.run_start.size() && whole.end_of_scan;
    pieces.emplace_back(std::move(piece));
  } while (run < whole.run_start.size());
  return pieces;
}

std::vector<Message> Split(const CandidateSet& whole) {
  std::vector<Message> pieces;
  size_t next = 0;
  do {
    CandidateSet piece{whole.utime_us, whole.scan, false, {}};
    size_t room = kRoomBytes;
    Take(whole.candidates, kCandidateBytes, next, room, piece.candidates);
    piece.end = next == whole.candidates.size() && whole.end;
    pieces.emplace_back(std::move(piece));
  } while (next < whole.candidates.size());
  return pieces;
}

}  // namespace

std::vector<Message> SplitForBus(Message message) {
  const MessageHeader longest_header{0, 0, 0, std::string(64, 's')};
  const size_t bytes = Encode(longest_header, message).size();
  if (bytes <= kMaxMessageBytes) return {std::move(message)};
  if (const auto* mesh = std::get_if<MeshDelta>(&message)) return Split(*mesh);
  if (const auto* voxels = std::get_if<VoxelDelta>(&message)) return Split(*voxels);
  if (const auto* candidates = std::get_if<CandidateSet>(&message)) return Split(*candidates);
  throw std::invalid_argument("SplitForBus: a message of " + std::to_string(bytes) + " bytes on " +
                              std::string(Wiring()[message.index()].channel) + " cannot be cut");
}

}  // namespace nbs
