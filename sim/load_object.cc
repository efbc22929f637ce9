#include "sim/load_object.h"

#include "common/geometry/mesh_io.h"
#include "common/runtime/error.h"
#include "sim/objects/statue.h"

namespace nbs {

bool HasTruth(const RunConfig& config) { return !config.object_file.empty() || config.object == kStatueName; }

TriangleMesh LoadObject(const RunConfig& config) {
  if (!HasTruth(config)) {
    throw ConfigError("The run " + config.folder.string() +
                      " has no true object: the simulator needs `object` or `object_file` in its run.yaml.");
  }
  return config.object_file.empty() ? MakeStatue() : ReadMesh(config.object_file);
}

}  // namespace nbs
