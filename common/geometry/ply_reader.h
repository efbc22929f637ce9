#pragma once

#include <string_view>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// Reads the content of a PLY file (ASCII, binary little- or big-endian) for ReadMesh: vertices with x, y, z and
/// perhaps nx, ny, nz, and faces with a list of vertex indices, cut into fans. Own code because assimp 5.2 crashes or
/// hangs on PLY files that are cut short.
///
/// Trailing bytes are ignored. Coordinates and indices come as they are in the file: the caller checks their range.
///
/// @throws std::runtime_error with the second half of a sentence ("is cut short: ...") for anything that is not a whole
/// PLY file.
TriangleMesh ParsePly(std::string_view content);

}  // namespace nbs
