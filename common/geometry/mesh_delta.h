#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// State of one mesh vertex, as published.
struct MeshVertex {
  uint32_t id = 0;                                     ///< Slot, stable for the life of the vertex.
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();       ///< Metres.
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< Unit length, towards the side that was seen.
  float sigma_m = 0.0f;                                ///< Standard deviation of the position along the normal.
  float best_incidence_rad = 0.0f;                     ///< Smallest angle between a beam and the normal so far.
  uint16_t measurements = 0;                           ///< 0: the vertex is no more.
  uint16_t first_scan = 0;
  uint16_t last_scan = 0;

  bool operator==(const MeshVertex&) const = default;
};

/// State of one triangle slot; three equal vertex numbers mean: the slot is empty.
struct MeshTriangle {
  uint32_t id = 0;
  std::array<uint32_t, 3> vertices{};

  bool operator==(const MeshTriangle&) const = default;
};

/// What changed in the mesh since the delta before it: the new state of every vertex and triangle slot that is not as
/// it was. A vertex comes in the same or an earlier delta than the first triangle that uses it.
struct MeshDelta {
  int64_t utime_us = 0;  ///< Time of the last stripe folded in.
  int32_t scan = 0;
  bool end_of_scan = false;  ///< True on the last delta of a scan: the mesh then holds everything of that scan.
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;

  bool operator==(const MeshDelta&) const = default;
};

/// The mesh after a scan, in figures. Published once a scan, after the last MeshDelta of the scan.
struct MeshScan {
  int64_t utime_us = 0;
  int32_t scan = 0;
  int32_t stripes = 0;  ///< Of this scan.
  int64_t points = 0;   ///< Of this scan, with a return.
  int64_t refused = 0;  ///< Measurements refused so far (not finite, negative, bad pose, stripe twice).
  int64_t vertices = 0;
  int64_t triangles = 0;
  int64_t edges = 0;          ///< n_total of eq. 3.
  int64_t border_edges = 0;   ///< n_border of eq. 3.
  double rim_length_m = 0.0;  ///< Sum of the lengths of the border edges.
  double completeness = 0.0;  ///< Eq. 3: 1 - n_border / n_total; 0 without edges.

  bool operator==(const MeshScan&) const = default;
};

/// No slot has this number or a higher one.
inline constexpr uint32_t kMaxSlots = 1u << 28;

/// Slots that a delta may leave out beyond those there are: vertices that came to nothing. More is a damaged message,
/// which would take all memory.
inline constexpr uint32_t kMaxSlotGap = 1u << 20;

/// A copy of the mesher's mesh, kept up to date by its deltas.
class MeshReplica {
 public:
  /// Applies one delta; deltas must come in the order in which they were published.
  ///
  /// @throws std::invalid_argument if the message is damaged, and changes nothing then: a slot number is not below
  /// kMaxSlots, or lies further beyond the slots there are than the delta's own number of elements and kMaxSlotGap; or
  /// a triangle that is not empty names a vertex slot that neither this delta nor an earlier one has filled or passed
  /// by.
  void Apply(const MeshDelta& delta);

  /// By slot; a slot whose vertex has no measurements is empty.
  const std::vector<MeshVertex>& vertices() const { return vertices_; }
  /// By slot; a slot with three equal vertex numbers is empty.
  const std::vector<std::array<uint32_t, 3>>& triangles() const { return triangles_; }

  static bool IsEmpty(const std::array<uint32_t, 3>& t) { return t[0] == t[1]; }

  /// Slots of the vertices that a triangle uses, ascending.
  std::vector<uint32_t> FindUsedVertices() const;

  /// The mesh without empty slots and without vertices that no triangle uses: vertex i is that of
  /// FindUsedVertices()[i], triangles in the order of their slots.
  TriangleMesh MakeCompactMesh() const;

 private:
  std::vector<MeshVertex> vertices_;
  std::vector<std::array<uint32_t, 3>> triangles_;
};

}  // namespace nbs
