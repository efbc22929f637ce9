#pragma once

#include "common/kinematics/arm_model.h"

namespace nbs {

/// Distance between two straight lines AB and CD, metres, all points in one frame; either may be a point. After
/// Ericson, "Real-Time Collision Detection", 2005, section 5.1.9.
double CalcSegmentDistance(const Eigen::Vector3d& p_A, const Eigen::Vector3d& p_B, const Eigen::Vector3d& p_C,
                           const Eigen::Vector3d& p_D);

/// Distance from a point to a box about the origin with half sizes `half`, metres; 0 inside.
double CalcBoxDistance(const Eigen::Vector3d& p_C, const Eigen::Vector3d& half);

/// Distance between a straight line AB and a box about the origin, metres; 0 where they meet. A may equal B.
///
/// Exact: along the line the square of the distance is convex and, between the planes of the box's faces, a parabola.
double CalcSegmentBoxDistance(const Eigen::Vector3d& p_CA, const Eigen::Vector3d& p_CB, const Eigen::Vector3d& half);

/// Distance between a block and a box about the origin of its frame L, metres; 0 where they meet.
///
/// Of two boxes apart the nearest points lie on an edge of one of them, and where two boxes meet so does a point of an
/// edge: the smallest of 24 distances.
double CalcBlockBoxDistance(const Block& block, const Eigen::Vector3d& half);

/// Capsules that cover a box: rows of equal ones along its longest side.
std::vector<Capsule> CoverBlock(const Block& block);

/// Spheres that cover a capsule; none reaches farther out than `overshoot_m` beyond it, > 0.
std::vector<Capsule> CoverCapsule(const Capsule& capsule, double overshoot_m);

}  // namespace nbs
