#include "sim/mesh_measures.h"

#include <algorithm>
#include <numeric>

namespace nbs {
namespace {

using Eigen::Vector3d;

Vector3d Corner(const TriangleMesh& mesh, size_t triangle, int i) {
  return mesh.vertices_W[mesh.triangles[triangle][i]].cast<double>();
}

/// Twice the area, along the normal.
Vector3d CalcCross(const TriangleMesh& mesh, size_t triangle) {
  const Vector3d a = Corner(mesh, triangle, 0);
  return (Corner(mesh, triangle, 1) - a).cross(Corner(mesh, triangle, 2) - a);
}

/// All directed edges, sorted.
std::vector<std::pair<uint32_t, uint32_t>> ListDirectedEdges(const TriangleMesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// For every directed edge a→b opposite vertex v of a triangle (v, a, b): walking a→b from b on must pass all triangles
/// of v before it closes.
bool HasOneRingEach(const TriangleMesh& mesh) {
  std::vector<std::array<uint32_t, 3>> spokes;  // (centre, from, to), sorted: a fan in which each `from` comes once
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) spokes.push_back({t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
  }
  std::sort(spokes.begin(), spokes.end());
  for (size_t begin = 0; begin < spokes.size();) {
    size_t end = begin;
    while (end < spokes.size() && spokes[end][0] == spokes[begin][0]) ++end;
    uint32_t at = spokes[begin][1];
    size_t steps = 0;
    do {
      const auto it = std::lower_bound(spokes.begin() + begin, spokes.begin() + end,
                                       std::array<uint32_t, 3>{spokes[begin][0], at, 0});
      if (it == spokes.begin() + end || (*it)[1] != at) return false;
      at = (*it)[2];
      ++steps;
    } while (at != spokes[begin][1] && steps <= end - begin);
    if (steps != end - begin) return false;
    begin = end;
  }
  return true;
}

}  // namespace

Eigen::AlignedBox3d CalcBoundingBox(const TriangleMesh& mesh_W) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : mesh_W.vertices_W) box.extend(p.cast<double>());
  return box;
}

std::vector<Eigen::Vector3d> CollectUsedVertices(const TriangleMesh& mesh_W) {
  std::vector<uint8_t> is_used(mesh_W.vertices_W.size(), 0);
  for (const auto& triangle : mesh_W.triangles) {
    for (const uint32_t v : triangle) is_used[v] = 1;
  }
  std::vector<Eigen::Vector3d> used_W;
  for (size_t v = 0; v < is_used.size(); ++v) {
    if (is_used[v] != 0) used_W.push_back(mesh_W.vertices_W[v].cast<double>());
  }
  return used_W;
}

std::vector<Eigen::Vector3f> CalcVertexNormals(const TriangleMesh& mesh_W) {
  std::vector<Vector3d> sums(mesh_W.vertices_W.size(), Vector3d::Zero());
  for (size_t t = 0; t < mesh_W.triangles.size(); ++t) {
    const Vector3d cross = CalcCross(mesh_W, t);
    for (uint32_t v : mesh_W.triangles[t]) sums[v] += cross;
  }
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(sums.size());
  for (const Vector3d& sum : sums) {
    normals.push_back((sum.norm() > 0.0 ? Vector3d(sum.normalized()) : Vector3d::UnitZ()).cast<float>());
  }
  return normals;
}

TriangleMesh KeepLargestPiece(const TriangleMesh& mesh_W) {
  std::vector<uint32_t> parent(mesh_W.vertices_W.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find_root = [&parent](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh_W.triangles) {
    parent[find_root(t[1])] = find_root(t[0]);
    parent[find_root(t[2])] = find_root(t[0]);
  }
  std::vector<size_t> count(parent.size(), 0);
  for (const auto& t : mesh_W.triangles) ++count[find_root(t[0])];
  const auto largest = static_cast<uint32_t>(std::max_element(count.begin(), count.end()) - count.begin());
  std::vector<uint32_t> number(parent.size(), 0);
  TriangleMesh piece;
  for (uint32_t v = 0; v < parent.size(); ++v) {
    if (find_root(v) != largest) continue;
    number[v] = static_cast<uint32_t>(piece.vertices_W.size());
    piece.vertices_W.push_back(mesh_W.vertices_W[v]);
    if (!mesh_W.normals_W.empty()) piece.normals_W.push_back(mesh_W.normals_W[v]);
  }
  for (const auto& t : mesh_W.triangles) {
    if (find_root(t[0]) == largest) piece.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  return piece;
}

double CalcArea(const TriangleMesh& mesh_W) {
  double sum = 0.0;
  for (size_t t = 0; t < mesh_W.triangles.size(); ++t) sum += CalcCross(mesh_W, t).norm();
  return 0.5 * sum;
}

double CalcVolume(const TriangleMesh& mesh_W) {
  double sum = 0.0;
  for (size_t t = 0; t < mesh_W.triangles.size(); ++t) sum += CalcCross(mesh_W, t).dot(Corner(mesh_W, t, 0));
  return sum / 6.0;
}

bool IsClosedManifold(const TriangleMesh& mesh_W) {
  const std::vector<std::pair<uint32_t, uint32_t>> edges = ListDirectedEdges(mesh_W);
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  for (const auto& [a, b] : edges) {
    if (a == b || !std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) return false;
  }
  return HasOneRingEach(mesh_W);
}

}  // namespace nbs
