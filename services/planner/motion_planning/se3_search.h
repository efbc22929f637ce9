#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/geometry/pose.h"

namespace nbs {

struct Se3SearchSettings {
  Eigen::AlignedBox3d box_W;    ///< Positions that the search may use, metres; grown to hold start and goal.
  double metres_per_rad = 0.3;  ///< What a turn counts against a way.
  int iterations = 2000;        ///< Extensions of the two trees before it gives up.
  double range_m = 0.3;         ///< Longest edge of the trees.
  int shortcuts = 40;           ///< Attempts to shorten the path that was found.
  uint64_t seed = 0;
};

using PoseCheck = std::function<bool(const Pose&)>;
using MotionCheck = std::function<bool(const Pose& from, const Pose& to)>;

/// Finds a motion of a free-flying body with RRT-Connect (Kuffner & LaValle, ICRA 2000, DOI 10.1109/ROBOT.2000.844730;
/// OMPL's implementation) and shortens it.
///
/// A pure function of its arguments: it neither uses nor disturbs OMPL's process-wide random numbers, and ends by
/// count, never by time.
///
/// @param is_free_motion  Decides about straight, evenly turning motions (Interpolate).
/// @returns Poses from start to goal, both exactly as given; every motion between two neighbours passed
/// `is_free_motion`. Empty if none was found.
std::vector<Pose> FindSe3Path(const Pose& X_WB_start, const Pose& X_WB_goal, const Se3SearchSettings& settings,
                              const PoseCheck& is_free, const MotionCheck& is_free_motion);

}  // namespace nbs
