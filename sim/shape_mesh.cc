#include "sim/shape_mesh.h"

#include <cmath>
#include <numbers>

namespace nbs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The square from `corner` along u and v, seen from u x v.
void AddSquare(const Vector3d& corner, const Vector3d& u, const Vector3d& v, TriangleMesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.vertices_W.size());
  const Vector3f normal = u.cross(v).normalized().cast<float>();
  for (const Vector3d& p : {corner, Vector3d(corner + u), Vector3d(corner + u + v), Vector3d(corner + v)}) {
    mesh.vertices_W.push_back(p.cast<float>());
    mesh.normals_W.push_back(normal);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

TriangleMesh MakeBlockMesh(const Block& block) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3;
    const int last = (axis + 2) % 3;
    for (const double sign : {1.0, -1.0}) {
      Vector3d corner = -block.half;
      corner[axis] = sign * block.half[axis];
      const Vector3d u = block.X_LC.linear() * (2.0 * block.half[next] * Vector3d::Unit(next));
      const Vector3d v = block.X_LC.linear() * (2.0 * block.half[last] * Vector3d::Unit(last));
      if (sign > 0.0) {
        AddSquare(block.X_LC * corner, u, v, mesh);
      } else {
        AddSquare(block.X_LC * corner, v, u, mesh);
      }
    }
  }
  return mesh;
}

/// Rings around the capsule's line, from pole to pole.
TriangleMesh MakeCapsuleMesh(const Capsule& capsule) {
  constexpr int kAround = 32;
  constexpr int kRings = 9;  // of half a ball
  const Vector3d way = capsule.p_B - capsule.p_A;
  const Vector3d axis = way.norm() > 1e-9 ? Vector3d(way.normalized()) : Vector3d(Vector3d::UnitZ());
  const Vector3d u = axis.unitOrthogonal();
  const Vector3d v = axis.cross(u);
  TriangleMesh mesh;
  for (int ring = 0; ring < 2 * kRings; ++ring) {
    const bool at_end = ring >= kRings;
    const double height = 0.5 * std::numbers::pi * (at_end ? ring - kRings : ring + 1 - kRings) / (kRings - 1);
    for (int k = 0; k < kAround; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / kAround;
      const Vector3d normal = std::sin(height) * axis + std::cos(height) * (std::cos(turn) * u + std::sin(turn) * v);
      mesh.vertices_W.push_back(((at_end ? capsule.p_B : capsule.p_A) + capsule.radius_m * normal).cast<float>());
      mesh.normals_W.push_back(normal.cast<float>());
    }
  }
  for (uint32_t ring = 0; ring + 1 < 2 * kRings; ++ring) {
    for (uint32_t k = 0; k < kAround; ++k) {
      const uint32_t a = ring * kAround + k, b = ring * kAround + (k + 1) % kAround;
      mesh.triangles.push_back({a, b, b + kAround});
      mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
  return mesh;
}

}  // namespace

void Drawing::Add(const TriangleMesh& mesh_W, const Vector3f& color, const std::vector<float>& openness) {
  const auto first = static_cast<uint32_t>(mesh_W_.vertices_W.size());
  const size_t count = mesh_W.vertices_W.size();
  mesh_W_.vertices_W.insert(mesh_W_.vertices_W.end(), mesh_W.vertices_W.begin(), mesh_W.vertices_W.end());
  mesh_W_.normals_W.insert(mesh_W_.normals_W.end(), mesh_W.normals_W.begin(), mesh_W.normals_W.end());
  for (const auto& t : mesh_W.triangles) mesh_W_.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  surface_.colors.insert(surface_.colors.end(), count, color);
  surface_.openness.insert(surface_.openness.end(), openness.begin(), openness.end());
  surface_.openness.resize(mesh_W_.vertices_W.size(), 1.0f);
}

void Drawing::Add(const Capsule& capsule_W, const Vector3f& color) { Add(MakeCapsuleMesh(capsule_W), color); }

void Drawing::Add(const Block& block_W, const Vector3f& color) { Add(MakeBlockMesh(block_W), color); }

TriangleMesh MakeVoxelMesh(const GridShape& grid, const std::function<bool(int64_t)>& is_shown) {
  TriangleMesh mesh;
  const double edge = grid.resolution_m;
  const auto shown_at = [&](const Eigen::Vector3i& at) {
    return (at.array() >= 0).all() && (at.array() < grid.size.array()).all() &&
           is_shown(grid.Index(at.x(), at.y(), at.z()));
  };
  for (int z = 0; z < grid.size.z(); ++z) {
    for (int y = 0; y < grid.size.y(); ++y) {
      for (int x = 0; x < grid.size.x(); ++x) {
        const Eigen::Vector3i at(x, y, z);
        if (!shown_at(at)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const Vector3d u = edge * Vector3d::Unit((axis + 1) % 3), v = edge * Vector3d::Unit((axis + 2) % 3);
          const Vector3d corner = grid.origin_W + edge * at.cast<double>();
          const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
          if (!shown_at(at + step)) AddSquare(corner + edge * Vector3d::Unit(axis), u, v, mesh);
          if (!shown_at(at - step)) AddSquare(corner, v, u, mesh);
        }
      }
    }
  }
  return mesh;
}

}  // namespace nbs
