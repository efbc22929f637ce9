#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <numbers>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// Square of half-width `half` in the plane z = `height`, normal +z, two triangles.
inline TriangleMesh MakeSquare(float half, float height) {
  TriangleMesh mesh;
  mesh.vertices_W = {{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Sphere around the origin: an octahedron whose triangles were cut in four `levels` times.
inline TriangleMesh MakeSphere(float radius, int levels) {
  TriangleMesh mesh;
  mesh.vertices_W = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.vertices_W.size()));
      if (is_new) mesh.vertices_W.push_back((mesh.vertices_W[a] + mesh.vertices_W[b]).normalized());
      return it->second;
    };
    std::vector<std::array<uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  mesh.normals_W = mesh.vertices_W;
  for (Eigen::Vector3f& p : mesh.vertices_W) p *= radius;
  return mesh;
}

}  // namespace nbs
