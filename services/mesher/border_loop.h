#pragma once

#include <cstdint>
#include <vector>

#include "services/mesher/mesh_topology.h"
#include "services/mesher/number_set.h"
#include "services/mesher/vertex_store.h"

namespace nbs {

enum class BorderWalk {
  kClosed,  ///< Came back.
  kLong,  ///< Has not come back after the most edges, on a border that crosses itself nowhere on the way: no walk from
          ///< a vertex on the way would come back either.
  kTangled,  ///< Did not come back, and other ways may.
};

/// Walks along the border from `start` over `second`, with the gap on the left, until it comes back.
///
/// @param start, second  Ends of a border edge; `second` is a border successor of `start`.
/// @param known_open     Vertices on borders that are long, or come back to be left open, and cross nothing; the border
///                       has not changed there since.
/// @param loop           Out: the vertices in order, `start` first; if kLong, up to where the rest is known.
/// @returns kTangled also if the way comes to a vertex twice.
BorderWalk FindBorderLoop(const MeshTopology& mesh, const VertexStore& vertices, uint32_t start, uint32_t second,
                          size_t most_edges, const NumberSet& known_open, std::vector<uint32_t>& loop);

}  // namespace nbs
