#pragma once

#include <cstdint>
#include <vector>

#include "services/mesher/mesh_topology.h"

namespace nbs {

/// Slots of the triangles at a vertex that are not in its largest fan (triangles joined by edges at the vertex), so
/// that without them the vertex has one fan. Of fans of equal size the one with the smallest slot stays. Empty if there
/// is one fan only.
std::vector<uint32_t> FindLesserFans(const MeshTopology& mesh, uint32_t vertex);

/// Triangles that hang together by edges with the one in slot `start`, nearest first: all of them if they are fewer
/// than `limit`, otherwise so many.
std::vector<uint32_t> FindPart(const MeshTopology& mesh, uint32_t start, size_t limit);

}  // namespace nbs
