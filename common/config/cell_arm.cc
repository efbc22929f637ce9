#include "common/config/cell_arm.h"

#include <fmt/format.h>

#include "common/kinematics/urdf_reader.h"
#include "common/runtime/error.h"

namespace nbs {

ArmModel ReadCellArm(const CellConfig& cell) {
  const ArmConfig& arm = cell.arm.value();
  ArmModel model = ReadArm(arm.urdf, arm.base_link, arm.flange_link);
  if (arm.start_rad.size() == model.joints.size()) return model;
  throw ConfigError(fmt::format("The cell {} gives {} joint values, but {} has {} moving joints.", cell.name,
                                arm.start_rad.size(), arm.urdf.string(), model.joints.size()));
}

}  // namespace nbs
