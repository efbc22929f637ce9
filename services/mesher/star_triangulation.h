#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/mesher/local_star.h"
#include "services/mesher/loop_filling.h"
#include "services/mesher/mesh_topology.h"
#include "services/mesher/vertex_store.h"

namespace nbs {

struct TriangulationSettings {
  float max_edge_m = 0.006f;           ///< R_max: no triangle has a longer edge.
  float max_circumradius_m = 0.0042f;  ///< No triangle has a larger circumscribed circle.
  float max_normal_angle_rad = 1.75f;  ///< Between the normals at the ends of an edge.
  float max_slope = 0.6f;  ///< Sine of the angle between an edge and the plane across the mean of its ends' normals,
  float slope_margin = 0.15f;   ///< or more by this than half the normals' angle explains.
  float max_bridge_m = 0.007f;  ///< Longest diagonal in the filling of a small loop.
  size_t least_part = 12;   ///< Parts of fewer triangles, joined to nothing by an edge, are held back until they grow.
  int max_loop_edges = 16;  ///< Disagreements between stars leave loops of at most so many edges; longer ones are real.
};

/// Keeps the triangles up to date with the vertices: a triangle is in the mesh if and only if all three of its vertices
/// have it in their Delaunay stars (a tangential Delaunay complex, after Boissonnat & Ghosh, DCG 2014,
/// DOI 10.1007/s00454-013-9557-2). A star has at most one triangle on each side of an edge, so no edge can have more
/// than two triangles, and the mesh depends on the vertices, not on the order in which they came. Where four nearly
/// cocircular vertices make the stars disagree a small loop stays open: these loops, and no others, are closed by ear
/// cutting.
class StarTriangulation {
 public:
  explicit StarTriangulation(const TriangulationSettings& settings) : settings_(settings) {}

  /// True if an edge between the two is allowed: near enough, same side, same sheet. Symmetric.
  bool MayJoin(const Vertex& a, const Vertex& b) const;

  /// Makes the stars of `due` anew and brings the triangles in line with them.
  ///
  /// @param due  Ascending numbers of real vertices that are new, have moved, or have such or a removed vertex within
  /// R_max.
  void Update(std::span<const uint32_t> due, VertexStore& vertices);

  /// Takes all triangles of a vertex out, before it is removed.
  void Detach(uint32_t id);

  const MeshTopology& topology() const { return topology_; }
  std::vector<uint32_t> TakeChangedSlots() { return topology_.TakeChangedSlots(); }

 private:
  static constexpr int32_t kAgreed =
      -1;  // Group of the triangles that the stars agree on; fillings have numbers from 0.

  bool MayBridge(const Vertex& a, const Vertex& b) const;
  void MakeStar(uint32_t id, VertexStore& vertices);
  bool IsAgreed(const MeshTopology::Triangle& t, const VertexStore& vertices) const;
  bool HasGoodShape(const MeshTopology::Triangle& t, const VertexStore& vertices) const;
  void RemoveDisagreed(uint32_t id, const VertexStore& vertices);
  void InsertAgreed(uint32_t id, const VertexStore& vertices);
  void RemoveFillingsAt(uint32_t id);
  void RemoveFilling(int32_t group);
  void RemoveTriangle(uint32_t slot);
  bool FindLoop(uint32_t start, uint32_t second, const VertexStore& vertices, std::vector<uint32_t>& loop) const;
  uint32_t FindLoopNext(uint32_t from, uint32_t at, const VertexStore& vertices,
                        std::vector<uint32_t>& successors) const;
  void InsertTriangle(const MeshTopology::Triangle& t);
  void ReturnHeldBack(const VertexStore& vertices);
  void HoldBackSmallParts();
  void HoldBack(const std::vector<uint32_t>& slots);
  void FillLoops(const VertexStore& vertices);
  void FillLoopsAt(uint32_t id, const VertexStore& vertices);
  void FillLoop(std::span<const uint32_t> loop, const VertexStore& vertices);

  TriangulationSettings settings_;
  MeshTopology topology_;
  std::vector<std::vector<uint32_t>> fillings_;  // Slots of the triangles of each filling.
  std::vector<int32_t> free_fillings_;
  std::vector<MeshTopology::Triangle> held_back_;
  std::vector<uint32_t> touched_in_update_;
  std::vector<uint32_t> touched_;  // Vertices of triangles that came or went in this update.
  std::vector<StarCandidate> candidates_;
  StarScratch scratch_;
};

}  // namespace nbs
