#pragma once

#include <filesystem>
#include <string>

#include "common/config/run_config.h"
#include "common/config/strict_reader.h"
#include "common/config/yaml_tree.h"

namespace nbs {

/// Reads the keys of a cell from a map: a whole cell file, or the `cell` of a run.yaml.
///
/// @param file     Named in errors; the arm's URDF lies relative to its folder.
/// @param missing  Whether an absent key keeps CellConfig's default.
/// @throws ConfigError as ReadCellConfig.
CellConfig ReadCell(const std::filesystem::path& file, const YamlTree& tree, StrictReader::Missing missing);

/// The cell as YAML lines, each after `indent`; every number reads back bit for bit.
std::string FormatCell(const CellConfig& cell, const std::string& indent);

/// The shortest decimal number that reads back as the same double.
std::string FormatNumber(double value);

/// "[x, y, z]".
std::string FormatVector(const Eigen::Vector3d& value);

/// A pose as a YAML flow map that reads back bit for bit.
std::string FormatPose(const Pose& X);

}  // namespace nbs
