#pragma once

#include "common/kinematics/arm_model.h"
#include "sim/scene.h"

namespace nbs {

// Distances of the bodies that a robot is made of, all in W, metres. Exact to a millionth of a body's length.

/// From a capsule to a triangle; negative where the triangle reaches into the capsule: how far it is from the capsule's
/// line, less the radius.
double CalcTriangleDistance(const Capsule& capsule_W, const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W,
                            const Eigen::Vector3d& c_W);

/// From a box to a triangle; 0 where they meet.
double CalcTriangleDistance(const Block& block_W, const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W,
                            const Eigen::Vector3d& c_W);

/// From a capsule or a box to a mesh; nullopt if none of its triangles is nearer than enough_m.
std::optional<double> FindDistance(const Capsule& capsule_W, const TriangleScene& scene_W, double enough_m);
std::optional<double> FindDistance(const Block& block_W, const TriangleScene& scene_W, double enough_m);

/// From a capsule or a box to a box; of two boxes 0 where they meet.
double CalcBlockDistance(const Capsule& capsule_W, const Block& block_W);
double CalcBlockDistance(const Block& block_W, const Block& other_W);

/// Height of the lowest point.
double CalcLowest(const Capsule& capsule_W);
double CalcLowest(const Block& block_W);

}  // namespace nbs
