#pragma once

#include <optional>
#include <span>
#include <vector>

#include "services/planner/motion_planning/collision_body.h"

namespace nbs {

/// The smallest step of a swept check, as the displacement of the fastest sphere, metres. Between two poses found free,
/// the body keeps at least its margin less half of this.
inline constexpr double kSweepTolerance = 0.001;

/// A stretch of a path: fractions of it, 0 <= begin <= end <= 1.
struct FreeInterval {
  double begin = 0.0;
  double end = 0.0;

  double length() const { return end - begin; }
  bool operator==(const FreeInterval&) const = default;
};

/// What a body meets along a path.
struct Sweep {
  std::vector<FreeInterval> free;  ///< Ascending, apart from each other.
  Touch worst = Touch::kFree;      ///< The worst that is touched anywhere on the path.

  bool is_free() const { return worst == Touch::kFree; }
  /// The longest; the first of several; none if nothing is free.
  std::optional<FreeInterval> FindLongest() const;
};

/// Moves the body along a path and finds where it is free.
///
/// The path runs through `poses_WB`, each piece after Interpolate (straight, even shortest turn) and each of the same
/// share of the fraction 0 … 1. Conservative advancement (Mirtich, PhD thesis, Berkeley 1996; Zhang et al., ACM TOG
/// 26(3), 2007, DOI 10.1145/1276377.1276396): from a free pose no sphere reaches anything before it has moved as far as
/// its distance, so the next pose looked at lies there and nothing thinner than a step is missed; from a touching pose
/// the body stays touching until the deepest sphere has moved out. Both ends are always looked at; a single pose is a
/// path without length.
///
/// @throws std::invalid_argument if there is no pose.
Sweep SweepPath(const CollisionBody& body, const Clearance& clearance, std::span<const Pose> poses_WB);

/// True exactly if SweepPath over the two poses is free. Stops at the first touch.
bool IsFreeMotion(const CollisionBody& body, const Clearance& clearance, const Pose& X_WB_start, const Pose& X_WB_end);

}  // namespace nbs
