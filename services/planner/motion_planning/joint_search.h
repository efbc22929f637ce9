#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/kinematics/arm_model.h"
#include "services/planner/motion_planning/motion_settings.h"

namespace nbs {

struct JointSearchSettings {
  SearchAlgorithm algorithm = SearchAlgorithm::kRrtConnect;
  std::vector<double> metres_per_rad;  ///< What a turn of each joint counts, > 0.
  int iterations = 400;                ///< Extensions of the two trees, or milestones, before it gives up.
  double range_m = 0.6;                ///< Longest edge of the trees, weighted.
  int shortcuts = 30;                  ///< Attempts to shorten the path that was found.
  double around_rad = 1.0;             ///< Three quarters of the samples lie so near to the box about start and goals.
  uint64_t seed = 0;
};

using JointCheck = std::function<bool(const Joints&)>;
using JointMotionCheck = std::function<bool(const Joints& from, const Joints& to)>;

/// A way of the joints to one of several goals.
struct JointWay {
  std::vector<Joints> q;  ///< From the start to the goal, both exactly as given; empty if none was found.
  size_t goal = 0;        ///< Number of the goal.
};

/// Finds a motion of an arm, with RRT-Connect or PRM of OMPL, to whichever of several goals it comes first, and
/// shortens it.
///
/// A pure function of its arguments: it neither uses nor disturbs OMPL's process-wide random numbers, and ends by
/// count, never by time. Every motion between two neighbours passed `is_free_motion`, which decides about straight
/// lines in joint space.
///
/// @pre At least one goal; start and goals within the limits.
JointWay FindJointWay(const ArmModel& model, const Joints& q_start, const std::vector<Joints>& q_goals,
                      const JointSearchSettings& settings, const JointCheck& is_free,
                      const JointMotionCheck& is_free_motion);

}  // namespace nbs
