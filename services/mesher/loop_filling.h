#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nbs {

/// A corner of a triangle or of a loop.
struct SurfaceCorner {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();       ///< Metres.
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< Unit.
};

/// Triangulates a small loop: of all triangulations whose triangles face the way that the loop as a whole faces and
/// stand on no corner's head, the one with the least sum of squared diagonals (dynamic programming after Klincsek,
/// "Minimal triangulations of polygonal domains", 1980). Ties go to the smaller corner numbers, so that the result is a
/// rule and not luck. What is invented is no more than an edge across a gap that measured surface surrounds.
///
/// @param corners   3 to 24, counter-clockwise seen from the normals' side. A loop that runs the other way, as the rim
/// of an island does, has no filling.
/// @param may_join  may_join(i, j), i < j: a diagonal between these corners is allowed.
/// @returns Triangles as corner numbers, counter-clockwise; empty if there is no such triangulation.
std::vector<std::array<uint32_t, 3>> TriangulateLoop(std::span<const SurfaceCorner> corners,
                                                     const std::function<bool(uint32_t, uint32_t)>& may_join);

/// True if the triangle has an area, faces the mean normal of its corners, and stands on no corner's head.
bool FacesItsNormals(const SurfaceCorner& a, const SurfaceCorner& b, const SurfaceCorner& c);

}  // namespace nbs
