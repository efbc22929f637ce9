#pragma once

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "common/geometry/mesh_delta.h"
#include "common/mapping/voxel_delta.h"
#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"

namespace nbs {

/// Everything that travels on a stream. Each alternative has exactly one channel and one sender
/// (common/messages/wiring.h).
using Message = std::variant<PlanRequest, Trajectory, RunState, RobotState, Execution, Profile, Stripe, MeshDelta,
                             MeshScan, VoxelDelta, Plan, CandidateSet, PlanTiming>;

/// Number of the stream that carries messages of type T: the alternative's index in Message.
template <typename T>
constexpr size_t StreamOf() {
  return []<typename... Ts>(std::variant<Ts...>*) {
    size_t index = 0;
    (void)((std::is_same_v<T, Ts> ? true : (++index, false)) || ...);
    return index;
  }(static_cast<Message*>(nullptr));
}

/// Collects what a node publishes, in order.
using Outbox = std::vector<Message>;

/// A service without the bus: a deterministic fold over its input streams.
///
/// A node is a process of a Kahn network (Kahn, "The semantics of a simple language for parallel programming", IFIP
/// 1974): it names the one stream that it reads next, and that choice depends only on what it has read before. The
/// order of arrival of messages on different streams, and when they come, therefore never reaches its results: the same
/// streams in give the same streams out, live, late, after a crash or from a log.
class Node {
 public:
  virtual ~Node() = default;

  /// Publishes what comes before any input. Called once, before the first Handle.
  virtual void Start(Outbox& out) { (void)out; }

  /// The stream (StreamOf<T>()) whose next message the node needs, or kNoInput when it has finished.
  virtual size_t NextInput() const = 0;
  static constexpr size_t kNoInput = static_cast<size_t>(-1);

  /// Folds the next message of the stream that NextInput() named, and appends what follows from it to `out`.
  virtual void Handle(const Message& message, Outbox& out) = 0;

  /// Counts of what was refused or went wrong so far, for the heartbeat: (name, count) pairs; names are static strings.
  struct Count {
    std::string_view name;
    int64_t count = 0;
  };
  virtual std::vector<Count> Complaints() const { return {}; }
};

}  // namespace nbs
