#pragma once

#include "common/config/cell_config.h"
#include "common/kinematics/arm_model.h"

namespace nbs {

/// The arm of a cell from its URDF (common/kinematics/urdf_reader.h).
///
/// @pre The cell has an arm.
/// @throws ConfigError if the URDF cannot be used, or the cell gives not one joint value for each of its joints.
ArmModel ReadCellArm(const CellConfig& cell);

}  // namespace nbs
