#pragma once

#include <cstdint>
#include <vector>

#include "services/mesher/mesh_topology.h"
#include "services/mesher/vertex_store.h"

namespace nbs {

/// Walks along the border from `start` over `second`, with the gap on the left, until it comes back.
///
/// @param start, second  Ends of a border edge; `second` is a border successor of `start`.
/// @param loop           Out: the vertices in order, `start` first.
/// @returns False if the way does not close within most_edges edges or comes to a vertex twice.
bool FindBorderLoop(const MeshTopology& mesh, const VertexStore& vertices, uint32_t start, uint32_t second,
                    size_t most_edges, std::vector<uint32_t>& loop);

}  // namespace nbs
