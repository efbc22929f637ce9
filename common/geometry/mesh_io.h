#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// An extra value per vertex in a PLY file, beside position and normal.
struct VertexProperty {
  std::string name;           ///< As in the PLY header: no blanks, unit in the name ("sigma_m").
  std::vector<float> values;  ///< One a vertex.
};

/// Writes a binary little-endian PLY: x y z, nx ny nz if the mesh has normals, the extra properties in the order given,
/// then the triangles. Equal input gives an equal file, byte for byte. The file appears whole or not at all (temporary
/// file, then rename).
///
/// @pre mesh.normals_W is empty or has one normal a vertex, every extra property one value a vertex;
/// std::invalid_argument otherwise.
/// @throws ConfigError if the file cannot be written.
void WriteMeshPly(const std::filesystem::path& file, const TriangleMesh& mesh,
                  std::span<const VertexProperty> extra = {});

/// Reads the triangles of a PLY (ASCII, binary little- or big-endian), STL or OBJ file, told apart by the extension.
/// Coordinates are taken as metres.
///
/// Vertices of STL and OBJ files, which repeat a corner for every face, are joined where all three coordinates are
/// equal; those of a PLY file keep number and order. Polygons are cut into fans. Triangles that use a vertex twice are
/// dropped. Normals are kept where a PLY file has them, at unit length. Other elements and properties are passed over.
///
/// @throws ConfigError, one sentence that names the file, if it is missing, empty, of another type, cut short,
/// malformed, without a triangle, has an
///         index out of range or a coordinate that is not finite.
TriangleMesh ReadMesh(const std::filesystem::path& file);

}  // namespace nbs
