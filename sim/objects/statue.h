#pragma once

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// The default object: a winged cherub on a plinth, 500 mm high, about 200,000 triangles. Made to be as hard as the
/// paper's putto: a relief of a face and curls, a bowl held high (a deep hollow), an arm akimbo (a loop to look
/// through), a gap between the legs, wings behind the back, cloth with folds.
///
/// Closed, outward-oriented 2-manifold; metres, z up, base on z = 0, the middle of its bounding box over the origin;
/// front towards -y. With vertex normals. The same on every call; takes one to two seconds.
TriangleMesh MakeStatue();

}  // namespace nbs
