#pragma once

#include <vector>

#include "services/planner/motion_planning/arm_chain.h"
#include "services/planner/motion_planning/motion_backend.h"

namespace nbs {

/// One way to drive a scan path with an arm.
struct ArmDrive {
  ScanPath path;          ///< The part that is driven, in the direction in which it is driven, with the sensor's roll.
  std::vector<Joints> q;  ///< At even fractions of it; every motion between two of them is free.
};

/// What of a scan path an arm can drive.
struct ArmReach {
  Verdict verdict = Verdict::kReachable;  ///< kReachable, kPartly, or why not.
  std::vector<ArmDrive> drives;           ///< Longer ones first; empty unless reachable or partly.
};

struct ArmReachSettings {
  double min_part_m = 0.03;
  bool half_turns = true;  ///< Rolled by half a turn the sensor sees the same. Not if its camera stands to one side.
  // Turns of the sensor about its viewing axis that are tried when neither the path as it stands nor half a turn lets
  // it be driven whole; the stripe then lies askew and is the narrower. Each also with half a turn.
  std::vector<double> skews_rad = {0.45, -0.45};
  size_t drives = 6;  ///< At most so many for each roll.
  ChainSettings chain;
};

/// The arm that a run has, ready for planning.
struct ArmSetup {
  InverseKinematics ik;
  ArmCollision collision;
  Pose X_FS;
  double scan_m_per_s = 0.05;
};

/// Checks a scan path: as it stands and rolled by half a turn, then askew (half turns only where the sensor sees the
/// same). The first two rolls that let all of it be driven are enough; if none does, the longest part stands for it.
/// Otherwise the verdict is the one that is nearest to success among the rolls as it stands and by half a turn: unknown
/// space, obstacle, self-collision, speed, joint limits, no inverse kinematics.
ArmReach FindArmReach(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                      const ArmReachSettings& settings = {});

/// The verdict of FindArmReach and the path of its first drive, without the other ways to drive it: rolls that cannot
/// let a longer part be driven than those before are not looked at.
PathCheck CheckArmPath(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                       const ArmReachSettings& settings = {});

}  // namespace nbs
