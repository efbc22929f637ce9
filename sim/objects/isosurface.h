#pragma once

#include <Eigen/Geometry>

#include "common/geometry/triangle_mesh.h"
#include "sim/objects/sdf_shape.h"

namespace nbs {

struct IsosurfaceSettings {
  double spacing = 1.0;      ///< Between samples, in the shape's unit; edges of the mesh come out about as long.
  int relax_iterations = 4;  ///< Each evens out the vertices and puts them back on the surface.
};

/// Meshes the surface of a shape: a closed, outward-oriented 2-manifold, always.
///
/// Surface nets (Gibson, MICCAI 1998): one vertex in each cell that the surface passes through. They are a manifold if
/// and only if the set of inner samples is well-composed (Latecki, Eckhardt, Rosenfeld, CVIU 61, 1995), so samples are
/// added to the inside until it is: no four samples of a face and no eight of a cell with just two diagonal ones of one
/// kind. Then the vertices are moved to the middle of their neighbours and, by Newton steps, onto the surface.
///
/// @param box  Everything of the shape lies in it, with at least two spacings to spare.
TriangleMesh MeshShape(const SdfShape& shape, const Eigen::AlignedBox3d& box, const IsosurfaceSettings& settings);

}  // namespace nbs
