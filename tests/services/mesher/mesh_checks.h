#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "common/geometry/mesh_delta.h"
#include "services/mesher/streaming_mesher.h"

namespace nbs {

/// Figures of a set of triangles, counted from scratch.
struct MeshFigures {
  int64_t triangles = 0;
  int64_t edges = 0;
  int64_t border_edges = 0;
  int64_t doubled_edges = 0;  ///< Directed edges with more than one triangle: not a manifold.
  int64_t bow_ties = 0;       ///< Vertices with more than one fan of triangles.
  double rim_length_m = 0.0;
  double mean_edge_m = 0.0;
  double longest_edge_m = 0.0;
  double area_m2 = 0.0;
};

template <typename Triangles>
MeshFigures CountMesh(const Triangles& triangles, const std::function<Eigen::Vector3f(uint32_t)>& p_W) {
  MeshFigures figures;
  std::map<std::pair<uint32_t, uint32_t>, int> directed;
  for (const auto& t : triangles) {
    if (t[0] == t[1]) continue;
    ++figures.triangles;
    figures.area_m2 += 0.5 * (p_W(t[1]) - p_W(t[0])).cross(p_W(t[2]) - p_W(t[0])).norm();
    for (int i = 0; i < 3; ++i) {
      if (++directed[{t[i], t[(i + 1) % 3]}] == 2) ++figures.doubled_edges;
    }
  }
  std::map<uint32_t, int> borders_at;
  for (const auto& [edge, count] : directed) {
    const double length = (p_W(edge.first) - p_W(edge.second)).norm();
    const bool border = !directed.contains({edge.second, edge.first});
    if (border) {
      ++figures.border_edges;
      if (++borders_at[edge.first] == 2) ++figures.bow_ties;
      figures.rim_length_m += length;
    }
    if (border || edge.first < edge.second) {
      ++figures.edges;
      figures.mean_edge_m += length;
    }
    figures.longest_edge_m = std::max(figures.longest_edge_m, length);
  }
  figures.mean_edge_m /= static_cast<double>(std::max<int64_t>(figures.edges, 1));
  return figures;
}

inline MeshFigures CountMesh(const StreamingMesher& mesher) {
  return CountMesh(mesher.topology().triangles(), [&](uint32_t id) { return mesher.vertices()[id].p_W; });
}

/// True if the replica has the mesher's triangles, slot by slot.
inline bool HasSameTriangles(const MeshReplica& replica, const StreamingMesher& mesher) {
  return replica.triangles().size() == mesher.topology().triangles().size() &&
         std::equal(replica.triangles().begin(), replica.triangles().end(), mesher.topology().triangles().begin());
}

/// Lengths, in edges, of the closed loops of the border; each border edge in one loop.
template <typename Triangles>
std::vector<int> CalcLoopLengths(const Triangles& triangles) {
  std::set<std::pair<uint32_t, uint32_t>> directed;
  for (const auto& t : triangles) {
    if (t[0] == t[1]) continue;
    for (int i = 0; i < 3; ++i) directed.insert({t[i], t[(i + 1) % 3]});
  }
  std::multimap<uint32_t, uint32_t> next;
  for (const auto& [a, b] : directed) {
    if (!directed.contains({b, a})) next.insert({b, a});
  }
  std::vector<int> lengths;
  while (!next.empty()) {
    int length = 0;
    auto it = next.begin();
    while (it != next.end()) {
      const uint32_t to = it->second;
      next.erase(it);
      ++length;
      it = next.find(to);
    }
    lengths.push_back(length);
  }
  return lengths;
}

}  // namespace nbs
