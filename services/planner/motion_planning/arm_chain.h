#pragma once

#include <vector>

#include "common/kinematics/inverse_kinematics.h"
#include "common/planning/scan_path.h"
#include "services/planner/motion_planning/arm_collision.h"

namespace nbs {

/// How joints follow a line.
struct ChainSettings {
  double step_m = 0.01;  ///< Between two poses of the line at which joint values are solved.
  double step_rad = 0.05;
  double largest_off_m = 0.0005;  ///< Of the flange, half-way between two poses, from the line; and
  double largest_off_rad = 0.005;
};

/// Joint values along a scan path, at even fractions of it from `begin` to `end`.
struct JointChain {
  int begin = 0;  ///< Number of the first pose of the line.
  std::vector<Joints> q;
  double travel_rad = 0.0;  ///< Sum over all joints and steps.

  int end() const { return begin + static_cast<int>(q.size()) - 1; }
};

/// Why a line cannot be followed, from what is fixed to what may change.
struct ChainResult {
  std::vector<JointChain> chains;         ///< The longest, one for each start that allows it, least travel first.
  Verdict verdict = Verdict::kReachable;  ///< Without a chain of the wanted length: why.
};

/// Follows a line of flange poses with the joints: continuous inverse kinematics.
///
/// At each pose all joint values (whole turns included) are nodes; two of neighbouring poses are joined if no joint
/// jumps or turns faster than it can in `step_s`, and the flange stays on the line half-way. Along nodes that touch
/// nothing the longest chains are found by dynamic programming, with the least travel of the joints.
///
/// @param X_WF     At even fractions of the line, at least two.
/// @param step_s   From one pose to the next at the scan speed.
/// @param wanted   A chain of fewer poses does not count.
ChainResult FindChains(const InverseKinematics& ik, const ArmCollision& collision, const Clearance& clearance,
                       const std::vector<Pose>& X_WF, double step_s, int wanted, const ChainSettings& settings = {});

/// Flange poses at even fractions of a scan path, so many that no step is longer than the settings allow.
std::vector<Pose> MakeLine(const Pose& X_FS, const ScanPath& path, const ChainSettings& settings = {});

}  // namespace nbs
