#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nbs {

/// A corner of a loop.
struct LoopCorner {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();       ///< Metres.
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< Unit.
};

/// Triangulates a small loop by cutting ears, shortest diagonal first (ties: the smaller corner number), so that the
/// result is a rule and not luck.
///
/// @param corners   3 to 16, counter-clockwise seen from the normals' side.
/// @param may_join  may_join(i, j): an edge between these corners is allowed.
/// @returns Triangles as corner numbers, counter-clockwise; empty if the loop cannot be closed by triangles that face
/// all their corners' normals.
std::vector<std::array<uint32_t, 3>> TriangulateLoop(std::span<const LoopCorner> corners,
                                                     const std::function<bool(uint32_t, uint32_t)>& may_join);

/// True if the triangle has an area and faces the normals of all its corners.
bool FacesItsNormals(const LoopCorner& a, const LoopCorner& b, const LoopCorner& c);

}  // namespace nbs
