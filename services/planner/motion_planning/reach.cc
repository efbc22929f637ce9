#include "services/planner/motion_planning/reach.h"

#include <algorithm>
#include <array>
#include <optional>

#include "services/planner/motion_planning/flange_path.h"

namespace nbs {
namespace {

constexpr double kSameLength = 1e-9;  // metres

bool IsWhole(const FreeInterval& interval) { return interval == FreeInterval{0.0, 1.0}; }

/// The longest part that is long enough to be worth a scan.
std::optional<FreeInterval> FindPart(const Sweep& sweep, double length_m, double min_part_m) {
  if (sweep.is_free()) return FreeInterval{0.0, 1.0};
  const std::optional<FreeInterval> longest = sweep.FindLongest();
  if (!longest || longest->length() * length_m < min_part_m - kSameLength) return std::nullopt;
  // A path without length has no part.
  if (length_m < min_part_m && !IsWhole(*longest)) return std::nullopt;
  return longest;
}

}  // namespace

Reach FindReach(const CollisionBody& body_F, const Pose& X_FS, const Clearance& clearance, const ScanPath& path,
                double min_part_m) {
  const std::array<ScanPath, 2> rolls = {path, RollPath(path)};
  const double length_m = path.length_m();
  Reach whole{Verdict::kReachable, {}};
  Reach parts{Verdict::kPartly, {}};
  for (const ScanPath& roll : rolls) {
    const Sweep sweep = SweepPath(body_F, clearance, MakeFlangePath(X_FS, roll));
    const std::optional<FreeInterval> part = FindPart(sweep, length_m, min_part_m);
    if (part && sweep.is_free()) {
      whole.paths.push_back(roll);
    } else if (part) {
      parts.paths.push_back(CutPath(roll, part->begin, part->end));
    }
  }
  if (!whole.paths.empty()) return whole;
  if (!parts.paths.empty()) {
    std::stable_sort(parts.paths.begin(), parts.paths.end(),
                     [](const ScanPath& a, const ScanPath& b) { return a.length_m() > b.length_m() + kSameLength; });
    return parts;
  }
  const bool may_open = std::any_of(rolls.begin(), rolls.end(), [&](const ScanPath& roll) {
    const Sweep sweep = SweepPath(body_F, ObstaclesOnly(clearance), MakeFlangePath(X_FS, roll));
    return FindPart(sweep, length_m, min_part_m).has_value();
  });
  return {may_open ? Verdict::kBlockedByUnknown : Verdict::kBlockedByObstacle, {}};
}

}  // namespace nbs
