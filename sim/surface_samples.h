#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// A point of a surface.
struct SurfaceSample {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();        ///< Metres.
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< Geometric normal of its triangle, unit length, outward.
};

/// Points even in area over a surface: the surface, laid out triangle after triangle, is cut into `count` parts of
/// equal area, and each part has its sample at the triangle of its middle. The same mesh and count give the same
/// samples.
///
/// @param truth_W  Triangles counter-clockwise seen from outside.
/// @throws std::invalid_argument if the surface has no area or count < 1.
std::vector<SurfaceSample> MakeSurfaceSamples(const TriangleMesh& truth_W, int count);

}  // namespace nbs
