#pragma once

#include <stdexcept>

namespace nbs {

/// Applies a delta to a replica (mesh or voxels), or leaves the replica as it is if the delta is damaged.
///
/// @returns Whether it was sound.
template <typename Delta, typename Replica>
[[nodiscard]] bool ApplyIfSound(const Delta& delta, Replica& replica) {
  try {
    replica.Apply(delta);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace nbs
