#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace nbs {

/// Edge with exactly one triangle, directed as in that triangle: seen from outside the surface lies on its left, the
/// missing neighbour on its right.
struct BorderEdge {
  uint32_t from = 0;
  uint32_t to = 0;
  uint32_t triangle = 0;  ///< Slot of the only triangle.

  bool operator==(const BorderEdge&) const = default;
};

/// Border edges that follow each other.
struct BorderLine {
  bool closed = false;
  std::vector<uint32_t> edges;  ///< Numbers in the list of border edges, in walking order.
  std::vector<uint32_t>
      vertices;  ///< Edge i starts at vertices[i]; an open chain has its last vertex as one entry more.
};

/// What a border line measures.
struct BorderMeasure {
  double length_m = 0.0;
  Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();  ///< Of the line itself: edge midpoints weighted by length.
  Eigen::Vector3d area_vector_W =
      Eigen::Vector3d::Zero();  ///< Half the sum of p_i x p_i+1 about the centroid, m²; zero for an open chain. The
                                ///< loop around a hole runs clockwise seen from outside, so minus this points outward.
};

/// Lists the edges that belong to exactly one triangle, ordered by (from, to). Slots with three equal vertices are
/// empty and passed over; an edge with three or more triangles is no border.
std::vector<BorderEdge> FindBorderEdges(std::span<const std::array<uint32_t, 3>> triangles);

/// Joins border edges to closed loops and, where the surface's orientation is broken, open chains. Every edge comes in
/// exactly one line.
///
/// At a vertex where several fans of triangles meet (a bow tie) a line goes on along the other side of the same gap, by
/// angle around the mean normal of the fans: two holes that touch in one vertex are two loops. A closed line starts at
/// its lowest vertex; lines are ordered by their lowest vertex, then by their first edge.
///
/// @param edges        As FindBorderEdges returns them: ordered by (from, to).
/// @param triangles    What the edges were found in.
/// @param positions_W  By vertex, metres.
std::vector<BorderLine> FindBorderLines(std::span<const BorderEdge> edges,
                                        std::span<const std::array<uint32_t, 3>> triangles,
                                        std::span<const Eigen::Vector3f> positions_W);

/// Length, centroid and area vector of a line; all zero without edges.
BorderMeasure CalcBorderMeasure(const BorderLine& line, std::span<const Eigen::Vector3f> positions_W);

}  // namespace nbs
