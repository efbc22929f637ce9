#pragma once

#include <vector>

#include "common/planning/scan_path.h"
#include "services/planner/motion_planning/swept_check.h"

namespace nbs {

/// What of a scan path can be driven (section III-E).
struct Reach {
  Verdict verdict = Verdict::kReachable;  ///< kReachable, kPartly, kBlockedByObstacle or kBlockedByUnknown.
  std::vector<ScanPath> paths;            ///< What can be driven: one for each roll that allows it; empty when blocked.
};

/// Checks a scan path, as it stands and, with `half_turns`, rolled by half a turn about the viewing axis, which scans
/// the same where no camera stands on one side.
///
/// If a roll lets all of it be driven the verdict is kReachable and `paths` holds it for each roll that does. Else if a
/// roll lets a part of at least `min_part_m` (all of a shorter path) be driven it is kPartly, with the longest part for
/// each roll, the longer one first. Else the path is blocked: by an obstacle if no such part would be left even if
/// everything unknown turned out free, by unknown space if one would. Ties go to the path as it stands.
/// A part is reachable when it is checked again by itself.
///
/// @param body_F       The body in the flange's frame F.
/// @param min_part_m   Metres, >= 0.
Reach FindReach(const CollisionBody& body_F, const Pose& X_FS, const Clearance& clearance, const ScanPath& path,
                double min_part_m, bool half_turns = true);

}  // namespace nbs
