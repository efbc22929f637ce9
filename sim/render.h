#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "common/geometry/borders.h"
#include "common/geometry/triangle_mesh.h"
#include "sim/png.h"
#include "sim/scene.h"

namespace nbs {

/// How a mesh is looked at, in parallel projection with z of W upwards.
struct View {
  double azimuth_rad =
      0.0;  ///< 0: from -y, looking along +y; growing angles walk counter-clockwise around the object seen from above.
  double elevation_rad = 0.2;  ///< Above the horizon, within +-1.5.
  int width = 700;             ///< Pixels.
  int height = 900;
  std::optional<Eigen::AlignedBox3d>
      frame_W;                ///< Shown whole, from every azimuth at one scale; default: the mesh's bounding box.
  bool mark_borders = false;  ///< Border edges (edges with one triangle) as red lines.
};

/// Draws pictures of one mesh: a light from the upper left with its shadow, and light from all around dimmed by how
/// hidden a vertex is. The back side of a surface comes out blue. The same mesh and view give the same picture.
class MeshRenderer {
 public:
  /// @param mesh_W  May be empty, open, and have no normals. Copied.
  explicit MeshRenderer(const TriangleMesh& mesh_W);

  Picture Render(const View& view) const;

  /// Front, left, back and right (azimuth 0, 90, 180, 270 degrees), the rest as in `view`.
  std::vector<Picture> RenderFourSides(View view) const;

 private:
  void CalcOpenness();

  TriangleMesh mesh_W_;
  TriangleScene scene_W_;
  std::vector<float> openness_;  ///< For each vertex, 0 hidden to 1 open to all sides.
  std::vector<BorderEdge> borders_;
};

}  // namespace nbs
