#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/mesher/local_star.h"
#include "services/mesher/loop_filling.h"
#include "services/mesher/mesh_topology.h"
#include "services/mesher/number_set.h"
#include "services/mesher/star_store.h"
#include "services/mesher/vertex_store.h"

namespace nbs {

struct TriangulationSettings {
  float max_edge_m = 0.006f;  ///< R_max: the stars agree on no longer edge.
  float max_circumradius_m = 0.0042f;
  float max_normal_angle_rad = 2.1f;  ///< Between the normals at the ends of an edge.
  /// Sine of the angle between an edge and the plane across the mean of its ends' normals.
  float max_slope = 0.6f;
  /// The slope may exceed what half the angle between the normals explains by this.
  float slope_margin = 0.15f;
  /// A vertex joins nothing if so many others lie in front of it: their sheet has passed before it, and rises over its
  /// own. So a point that noise puts into a wall joins no sides.
  int least_in_front = 4;
  /// A loop of at most so many edges is closed if that takes no diagonal longer than max_bridge_m.
  size_t max_loop_edges = 24;
  float max_bridge_m = 0.007f;
  /// Nor one between walls that face each other, unless something was measured about halfway, within this of its
  /// middle.
  float ground_reach_m = 0.003f;
  /// Parts of fewer triangles, joined to nothing by an edge, are held back until they grow.
  size_t least_part = 12;
};

/// Keeps the triangles up to date with the vertices.
///
/// The stars agree on a triangle if all three of its vertices have it in their Delaunay stars (a tangential Delaunay
/// complex, after Boissonnat & Ghosh, DCG 2014, DOI 10.1007/s00454-013-9557-2). A star has at most one triangle on each
/// side of an edge, so no edge can have more than two, and what is agreed depends on where the vertices are, not on the
/// order in which they came. Where stars disagree (four nearly cocircular vertices, a sharp ridge) a small loop stays
/// open; loops that can be closed within max_bridge_m are closed. Each vertex of the mesh has one fan of triangles: of
/// fans that meet in one vertex only the largest is shown. What is held back comes back as soon as something changes
/// beside it.
class StarTriangulation {
 public:
  /// @param measurements  Outlive it.
  StarTriangulation(const MeasurementMap& measurements, const TriangulationSettings& settings);

  /// True if an edge between the two is allowed: near enough, same side, same sheet. Symmetric.
  bool MayJoin(const Vertex& a, const Vertex& b) const;

  /// True if a diagonal between the two is allowed where a loop is closed: short enough, and not across a crevice whose
  /// ground was not measured. Symmetric.
  bool MayBridge(const Vertex& a, const Vertex& b) const;

  /// Makes the stars of `due` anew and brings the triangles in line with them.
  ///
  /// @param due  Ascending numbers of the real vertices that are new or have moved, and of those within R_max of one.
  void Update(std::span<const uint32_t> due, const VertexStore& vertices);

  const MeshTopology& topology() const { return topology_; }
  /// True if the vertex had neighbours on all sides when its star was made.
  bool IsSurrounded(uint32_t id) const { return stars_.IsClosed(id); }
  std::vector<uint32_t> TakeChangedSlots() { return topology_.TakeChangedSlots(); }
  /// See MeshTopology.
  template <typename Visit>
  void ForEachBorderEdge(Visit&& visit) {
    topology_.ForEachBorderEdge(visit);
  }

 private:
  // Group of the triangles that the stars agree on; fillings have numbers from 0.
  static constexpr int32_t kAgreed = -1;

  bool IsMeasuredBetween(const Vertex& a, const Vertex& b) const;
  void MakeStar(uint32_t id, const VertexStore& vertices);
  bool IsAgreed(const MeshTopology::Triangle& t, const VertexStore& vertices) const;
  bool HasGoodShape(const MeshTopology::Triangle& t, const VertexStore& vertices) const;
  void RemoveDisagreed(uint32_t id, const VertexStore& vertices);
  void InsertAgreed(uint32_t id, const VertexStore& vertices);
  void RemoveFillingsAt(uint32_t id);
  void RemoveFilling(int32_t group);
  void RemoveTriangle(uint32_t slot);
  void InsertTriangle(const MeshTopology::Triangle& t);
  void ReturnHeldBack(const VertexStore& vertices);
  void HoldBackLesserFans();
  void HoldBackIslands();
  void HoldBack(const std::vector<uint32_t>& slots);
  void FillLoops(const VertexStore& vertices);
  void FillLoopsAt(uint32_t id, const VertexStore& vertices);
  bool IsSimple(std::span<const uint32_t> loop) const;
  bool FillLoop(std::span<const uint32_t> loop, const VertexStore& vertices);

  const MeasurementMap& measurements_;
  TriangulationSettings settings_;
  float least_normal_cosine_;
  MeshTopology topology_;
  StarStore stars_;
  std::vector<std::vector<uint32_t>> fillings_;  // Slots of the triangles of each filling.
  std::vector<int32_t> free_fillings_;
  std::vector<MeshTopology::Triangle> held_back_;
  std::vector<uint32_t> touched_;            // Vertices of triangles that came or went since the last look at them,
  std::vector<uint32_t> touched_in_update_;  // and in the whole update.
  NumberSet open_border_;                    // Vertices on borders known to stay open.
  NumberSet large_parts_;                    // Vertices of parts known not to be held back.
  NumberSet checked_;                        // Slots of triangles that all stars have been asked about.
  std::vector<uint32_t> slots_;
  std::vector<StarCandidate> candidates_;
  StarScratch scratch_;
};

}  // namespace nbs
