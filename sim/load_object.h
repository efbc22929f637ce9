#pragma once

#include "common/config/run_config.h"
#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// True if the run has a true object: the built-in statue or a mesh file.
bool HasTruth(const RunConfig& config);

/// The true object of a run, in W: config.object_file, or the statue if config.object names it.
///
/// @throws ConfigError if the run has no true object, or as ReadMesh.
TriangleMesh LoadObject(const RunConfig& config);

/// Name of the object that ships with the project.
inline constexpr std::string_view kStatueName = "statue";

}  // namespace nbs
