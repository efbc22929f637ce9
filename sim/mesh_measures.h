#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// Smallest axis-aligned box around all vertices, metres; empty for a mesh without vertices.
Eigen::AlignedBox3d CalcBoundingBox(const TriangleMesh& mesh_W);

/// The vertices that a triangle uses, in their order, metres.
std::vector<Eigen::Vector3d> CollectUsedVertices(const TriangleMesh& mesh_W);

/// Unit normals at the vertices: mean of the triangles' normals weighted by area. A vertex without triangle gets +z.
std::vector<Eigen::Vector3f> CalcVertexNormals(const TriangleMesh& mesh_W);

/// The connected piece with the most triangles (the first of them on a tie), its vertices in their old order.
TriangleMesh KeepLargestPiece(const TriangleMesh& mesh_W);

/// Area of the surface, square metres.
double CalcArea(const TriangleMesh& mesh_W);

/// Enclosed volume, cubic metres; positive if the triangles of a closed surface are oriented outward.
double CalcVolume(const TriangleMesh& mesh_W);

/// True if every edge has exactly two triangles that run along it in opposite directions, and the triangles around
/// every vertex form one ring: a closed, consistently oriented 2-manifold.
bool IsClosedManifold(const TriangleMesh& mesh_W);

}  // namespace nbs
