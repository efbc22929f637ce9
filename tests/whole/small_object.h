#pragma once

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// What a whole run takes a second for: a sphere of 40 mm with a bump.
TriangleMesh MakeSmallObject();

}  // namespace nbs
