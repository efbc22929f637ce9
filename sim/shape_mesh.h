#pragma once

#include <functional>

#include "common/geometry/triangle_mesh.h"
#include "common/kinematics/arm_model.h"
#include "common/mapping/voxel_delta.h"
#include "sim/render.h"

namespace nbs {

/// A mesh to be drawn, put together from parts of several colours.
class Drawing {
 public:
  /// A mesh as it is.
  ///
  /// @param mesh_W    With normals.
  /// @param openness  One value a vertex; empty: all open.
  void Add(const TriangleMesh& mesh_W, const Eigen::Vector3f& color, const std::vector<float>& openness = {});

  void Add(const Capsule& capsule_W, const Eigen::Vector3f& color);
  void Add(const Block& block_W, const Eigen::Vector3f& color);

  const TriangleMesh& mesh_W() const { return mesh_W_; }
  const Surface& surface() const { return surface_; }

 private:
  TriangleMesh mesh_W_;
  Surface surface_;
};

/// Faces of the voxels for which `is_shown` holds, towards those for which it does not; flat, with normals. A voxel is
/// given by its index, and what lies outside of the grid is not shown.
TriangleMesh MakeVoxelMesh(const GridShape& grid, const std::function<bool(int64_t)>& is_shown);

}  // namespace nbs
