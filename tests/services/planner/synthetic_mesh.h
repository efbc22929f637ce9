#pragma once

#include <cmath>
#include <functional>

#include "common/geometry/mesh_delta.h"

namespace nbs {

/// A point of a surface with its outward normal.
struct SurfacePoint {
  Eigen::Vector3d p_W;
  Eigen::Vector3d normal_W;
};

/// Meshes a parametric surface on a grid of columns x rows vertices: `surface(column, row)`, where (d/dcolumn) x
/// (d/drow) points outward. Squares for which `keep(column, row)` is false are left out. All vertices carry
/// `scan(column, row)` as their last scan.
inline MeshReplica MakeGridMesh(
    int columns, int rows, const std::function<SurfacePoint(int, int)>& surface,
    const std::function<bool(int, int)>& keep = [](int, int) { return true; },
    const std::function<int(int, int)>& scan = [](int, int) { return 0; }) {
  MeshDelta delta;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const SurfacePoint point = surface(c, r);
      MeshVertex v;
      v.id = static_cast<uint32_t>(r * columns + c);
      v.p_W = point.p_W.cast<float>();
      v.normal_W = point.normal_W.cast<float>();
      v.measurements = 1;
      v.last_scan = static_cast<uint16_t>(scan(c, r));
      delta.vertices.push_back(v);
      if (c + 1 == columns || r + 1 == rows || !keep(c, r)) continue;
      const auto columns_u = static_cast<uint32_t>(columns);
      const auto slot = static_cast<uint32_t>(delta.triangles.size());
      delta.triangles.push_back({slot, {v.id, v.id + 1, v.id + columns_u + 1}});
      delta.triangles.push_back({slot + 1, {v.id, v.id + columns_u + 1, v.id + columns_u}});
    }
  }
  MeshReplica mesh;
  mesh.Apply(delta);
  return mesh;
}

/// A plane of 3 mm squares in z = 0 from the origin towards +x and +y, seen from +z.
inline MeshReplica MakePlaneMesh(
    int columns, int rows, const std::function<bool(int, int)>& keep = [](int, int) { return true; },
    const std::function<int(int, int)>& scan = [](int, int) { return 0; }) {
  const auto surface = [](int c, int r) { return SurfacePoint{{0.003 * c, 0.003 * r, 0.0}, Eigen::Vector3d::UnitZ()}; };
  return MakeGridMesh(columns, rows, surface, keep, scan);
}

/// Point of a cylinder about the world's z axis.
inline SurfacePoint CalcCylinderPoint(double radius, double angle, double z) {
  const Eigen::Vector3d normal(std::cos(angle), std::sin(angle), 0.0);
  return {radius * normal + z * Eigen::Vector3d::UnitZ(), normal};
}

/// The part of a cylinder about z between two angles (radians) and from z = 0 to `height`, in about 3 mm squares.
inline MeshReplica MakeCylinderMesh(double radius, double from, double to, double height) {
  const int columns = 1 + static_cast<int>(std::ceil(radius * (to - from) / 0.003));
  const int rows = 1 + static_cast<int>(std::ceil(height / 0.003));
  return MakeGridMesh(columns, rows, [=](int c, int r) {
    return CalcCylinderPoint(radius, from + (to - from) * c / (columns - 1), height * r / (rows - 1));
  });
}

}  // namespace nbs
