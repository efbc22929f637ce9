#pragma once

#include <filesystem>
#include <string>

#include "common/kinematics/arm_model.h"

namespace nbs {

/// Reads an arm from a URDF file: the chain of turning joints from a base link to a flange link, with limits, speeds
/// and collision bodies. Fixed joints are folded in: what they attach to a link of the chain moves, and collides, with
/// it.
///
/// Collision shapes are boxes, spheres and cylinders. A cylinder counts as the capsule about it (rounded off beyond
/// both ends); a sphere that lies in such a capsule adds nothing and is left out, so a capsule can be written as a
/// cylinder with a sphere at either end and every reader sees the same body.
///
/// urdfdom reads what it can and passes over the rest; here the XML is looked at as well, so that nothing is lost
/// silently.
///
/// @throws ConfigError, one sentence that names the file, if it cannot be read, is no XML or no URDF; a link is missing
/// or does not hang on the base; a joint of the chain does not turn, mimics another, or lacks a lower or upper limit or
/// a speed; a link of the chain has no collision body, or a shape of it is malformed or a mesh; a joint off the chain
/// moves; there are more than kMaxJoints joints, or none.
ArmModel ReadArm(const std::filesystem::path& file, const std::string& base_link, const std::string& flange_link);

}  // namespace nbs
