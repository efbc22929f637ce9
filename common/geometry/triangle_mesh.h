#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace nbs {

/// Indexed triangles in the world frame, metres; each triangle's vertices run counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_W;
  std::vector<Eigen::Vector3f> normals_W;  ///< One a vertex, unit length, outward; or empty.
  std::vector<std::array<uint32_t, 3>> triangles;
};

}  // namespace nbs
