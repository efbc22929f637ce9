#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/borders.h"
#include "common/geometry/mesh_delta.h"

namespace nbs {

/// The mesh as boundary search and hole detection read it: borders and neighbours, made once a round.
class BoundarySurface {
 public:
  explicit BoundarySurface(const MeshReplica& mesh);

  std::span<const BorderEdge> edges() const { return edges_; }
  std::span<const BorderLine> lines() const { return lines_; }
  std::span<const Eigen::Vector3f> positions_W() const { return positions_W_; }
  /// Of the vertices that triangles use, metres; empty without triangles.
  const Eigen::AlignedBox3d& box_W() const { return box_W_; }

  Eigen::Vector3d Position(uint32_t vertex) const { return positions_W_[vertex].cast<double>(); }
  Eigen::Vector3d Normal(uint32_t vertex) const { return mesh_->vertices()[vertex].normal_W.cast<double>(); }
  int LastScan(uint32_t vertex) const { return mesh_->vertices()[vertex].last_scan; }
  /// Vertices that share an edge with `vertex`; inner neighbours come twice.
  std::span<const uint32_t> Neighbours(uint32_t vertex) const;

  /// Unit normal of the border edge's triangle.
  Eigen::Vector3d CalcTriangleNormal(const BorderEdge& edge) const;

  /// Grows a region over mesh edges: all vertices within `reach_m` of the seeds along edges whose normals agree with
  /// `normal_W` within an angle. Ordered by vertex number; seeds are always part of it.
  ///
  /// @param min_cosine  Of the largest angle between a vertex normal and `normal_W`.
  std::vector<uint32_t> GrowRegion(std::span<const uint32_t> seeds, double reach_m, const Eigen::Vector3d& normal_W,
                                   double min_cosine) const;

 private:
  const MeshReplica* mesh_;
  std::vector<Eigen::Vector3f> positions_W_;
  std::vector<BorderEdge> edges_;
  std::vector<BorderLine> lines_;
  Eigen::AlignedBox3d box_W_;
  std::vector<uint32_t> neighbour_start_;
  std::vector<uint32_t> neighbours_;
};

}  // namespace nbs
