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
  bool tight = false;         ///< The frame fills this picture, whatever another azimuth would need.
  bool mark_borders = false;  ///< Border edges (edges with one triangle) as red lines.
};

/// How the surface of a mesh looks; one value a vertex, or nothing.
struct Surface {
  std::vector<Eigen::Vector3f> colors;  ///< Red, green, blue in linear light, 0 to 1; default: stone.
  std::vector<float> openness;          ///< 0 hidden to 1 open to all sides; default: worked out from the mesh.
};

/// Where points in W lie in a picture of a view, pixels from its upper left corner.
class Projection {
 public:
  /// @param box_W  What the view shows when it names no frame.
  Projection(const View& view, const Eigen::AlignedBox3d& box_W);

  Eigen::Vector2d Project(const Eigen::Vector3d& p_W) const;

 private:
  Eigen::Vector3d right_W_, down_W_, corner_W_;
  double pixel_m_;
};

/// Draws pictures of one mesh: a light from the upper left with its shadow, and light from all around dimmed by how
/// hidden a vertex is. The back side of a surface comes out blue. The same mesh and view give the same picture.
class MeshRenderer {
 public:
  /// @param mesh_W  May be empty, open, and have no normals. Copied.
  explicit MeshRenderer(const TriangleMesh& mesh_W, Surface surface = {});

  Picture Render(const View& view) const;

  /// For each point whether the mesh hides it from the view.
  std::vector<uint8_t> FindHidden(const std::vector<Eigen::Vector3d>& points_W, const View& view) const;

 private:
  void CalcOpenness();

  TriangleMesh mesh_W_;
  TriangleScene scene_W_;
  Surface surface_;
  std::vector<BorderEdge> borders_;
};

}  // namespace nbs
