#pragma once

#include <filesystem>

#include "common/kinematics/urdf_reader.h"
#include "common/runtime/counter_random.h"

namespace nbs {

inline ArmModel ReadKr16() {
  return ReadArm(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/kr16.urdf", "base_link", "tool0");
}

inline ArmModel ReadTestArm(const std::string& name, const std::string& base) {
  return ReadArm(std::filesystem::path(NBS_SOURCE_DIR) / "tests/common/kinematics" / name, base, "tool0");
}

/// Joint values even within the limits.
inline Joints MakeRandomJoints(const ArmModel& model, uint64_t seed, uint64_t number) {
  Joints q(model.n());
  for (int k = 0; k < model.n(); ++k) {
    const ArmJoint& joint = model.joints[k];
    q[k] = joint.min_rad + (joint.max_rad - joint.min_rad) * CalcUniform({seed, number, static_cast<uint64_t>(k)});
  }
  return q;
}

}  // namespace nbs
