#include "services/planner/motion_planning/reach.h"

#include <algorithm>
#include <optional>

#include "services/planner/motion_planning/flange_path.h"

namespace nbs {
namespace {

constexpr double kSameLength = 1e-9;  // metres

/// What FindDrivable found: a path that was swept whole and is free.
struct Drivable {
  ScanPath path;
  bool whole = false;
};

/// The longest part that is long enough to be worth a scan.
///
/// A part is swept again by itself, and cut again if need be: other poses of it are looked at, and with a sensor off
/// the flange's origin it is another chain of pieces. So what is returned is found free whenever it is looked at again.
std::optional<Drivable> FindDrivable(const CollisionBody& body_F, const Pose& X_FS, const Clearance& clearance,
                                     const ScanPath& path, double min_part_m) {
  constexpr int kCuts = 10;
  const double wanted_m = std::min(min_part_m, path.length_m()) - kSameLength;
  ScanPath part = path;
  for (int cut = 0; cut < kCuts; ++cut) {
    const Sweep sweep = SweepPath(body_F, clearance, MakeFlangePath(X_FS, part));
    if (sweep.is_free()) return Drivable{part, cut == 0};
    const std::optional<FreeInterval> longest = sweep.FindLongest();
    if (!longest || path.length_m() < min_part_m) return std::nullopt;
    part = CutPath(part, longest->begin, longest->end);
    if (part.length_m() < wanted_m) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

Reach FindReach(const CollisionBody& body_F, const Pose& X_FS, const Clearance& clearance, const ScanPath& path,
                double min_part_m, bool half_turns) {
  std::vector<ScanPath> rolls = {path};
  if (half_turns) rolls.push_back(RollPath(path));
  Reach whole{Verdict::kReachable, {}};
  Reach parts{Verdict::kPartly, {}};
  for (const ScanPath& roll : rolls) {
    const std::optional<Drivable> drivable = FindDrivable(body_F, X_FS, clearance, roll, min_part_m);
    if (drivable) (drivable->whole ? whole : parts).paths.push_back(drivable->path);
  }
  if (!whole.paths.empty()) return whole;
  if (!parts.paths.empty()) {
    std::stable_sort(parts.paths.begin(), parts.paths.end(),
                     [](const ScanPath& a, const ScanPath& b) { return a.length_m() > b.length_m() + kSameLength; });
    return parts;
  }
  const ObstaclesOnly obstacles(clearance);
  const bool may_open = std::any_of(rolls.begin(), rolls.end(), [&](const ScanPath& roll) {
    return FindDrivable(body_F, X_FS, obstacles, roll, min_part_m).has_value();
  });
  return {may_open ? Verdict::kBlockedByUnknown : Verdict::kBlockedByObstacle, {}};
}

}  // namespace nbs
