#include "services/planner/boundary_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace nbs {

BoundarySurface::BoundarySurface(const MeshReplica& mesh) : mesh_(&mesh) {
  positions_W_.reserve(mesh.vertices().size());
  for (const MeshVertex& v : mesh.vertices()) positions_W_.push_back(v.p_W);
  edges_ = FindBorderEdges(mesh.triangles());
  lines_ = FindBorderLines(edges_, mesh.triangles(), positions_W_);

  neighbour_start_.assign(positions_W_.size() + 1, 0);
  for (const auto& t : mesh.triangles()) {
    if (MeshReplica::IsEmpty(t)) continue;
    for (uint32_t v : t) {
      neighbour_start_[v + 1] += 2;
      box_W_.extend(Position(v));
    }
  }
  for (size_t v = 1; v < neighbour_start_.size(); ++v) neighbour_start_[v] += neighbour_start_[v - 1];
  neighbours_.resize(neighbour_start_.back());
  std::vector<uint32_t> fill(neighbour_start_.begin(), neighbour_start_.end() - 1);
  for (const auto& t : mesh.triangles()) {
    if (MeshReplica::IsEmpty(t)) continue;
    for (int c = 0; c < 3; ++c) {
      neighbours_[fill[t[c]]++] = t[(c + 1) % 3];
      neighbours_[fill[t[c]]++] = t[(c + 2) % 3];
    }
  }
}

std::span<const uint32_t> BoundarySurface::Neighbours(uint32_t vertex) const {
  return std::span(neighbours_)
      .subspan(neighbour_start_[vertex], neighbour_start_[vertex + 1] - neighbour_start_[vertex]);
}

Eigen::Vector3d BoundarySurface::CalcTriangleNormal(const BorderEdge& edge) const {
  const auto& t = mesh_->triangles()[edge.triangle];
  return (Position(t[1]) - Position(t[0])).cross(Position(t[2]) - Position(t[0])).normalized();
}

std::vector<uint32_t> BoundarySurface::GrowRegion(std::span<const uint32_t> seeds, double reach_m,
                                                  const Eigen::Vector3d& normal_W, double min_cosine) const {
  using Entry = std::pair<double, uint32_t>;  // way along edges, vertex
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<double> way(positions_W_.size(), std::numeric_limits<double>::infinity());
  std::vector<uint32_t> region;
  const auto reach = [&](uint32_t v, double distance) {
    if (way[v] <= distance) return;
    if (std::isinf(way[v])) region.push_back(v);
    way[v] = distance;
    open.emplace(distance, v);
  };
  for (uint32_t v : seeds) reach(v, 0.0);
  while (!open.empty()) {
    const auto [distance, v] = open.top();
    open.pop();
    if (distance > way[v]) continue;
    for (uint32_t n : Neighbours(v)) {
      const double next = distance + (positions_W_[n] - positions_W_[v]).norm();
      if (next <= reach_m && Normal(n).dot(normal_W) >= min_cosine) reach(n, next);
    }
  }
  std::sort(region.begin(), region.end());
  return region;
}

}  // namespace nbs
