// What the mesher tells about its mesh.

#include <algorithm>
#include <cmath>

#include "services/mesher/streaming_mesher.h"

namespace nbs {

MeshDelta StreamingMesher::TakeDelta() {
  MeshDelta delta;
  delta.utime_us = scan_.utime_us;
  delta.scan = scan_.scan;
  delta.end_of_scan = scan_ended_;
  CollectVertices(delta);
  for (uint32_t slot : triangulation_.TakeChangedSlots())
    delta.triangles.push_back({slot, topology().triangles()[slot]});
  return delta;
}

void StreamingMesher::CollectVertices(MeshDelta& delta) {
  std::sort(publish_due_.begin(), publish_due_.end());
  std::vector<uint32_t> held_back;
  for (uint32_t id : publish_due_) {
    Vertex& v = vertices_[id];
    const bool noticeable = !v.published || (v.p_W - v.published_p_W).norm() > settings_.moved_noticeably_m;
    if (!noticeable && !scan_ended_) {
      held_back.push_back(id);
      continue;
    }
    v.publish_due = false;
    v.published = true;
    v.published_p_W = v.p_W;
    delta.vertices.push_back({id, v.p_W, v.normal_W, 1.0f / std::sqrt(v.information),
                              std::acos(std::clamp(v.best_cosine, -1.0f, 1.0f)), v.measurements, v.first_scan,
                              v.last_scan});
  }
  publish_due_ = std::move(held_back);
}

double StreamingMesher::CalcRimLength() {
  double length_m = 0.0;
  triangulation_.ForEachBorderEdge(
      [&](uint32_t a, uint32_t b) { length_m += static_cast<double>((vertices_[b].p_W - vertices_[a].p_W).norm()); });
  return length_m;
}

MeshScan StreamingMesher::CalcScanFigures() {
  MeshScan figures = scan_;
  figures.refused = counts_.refused_measurements + counts_.refused_stripes;
  figures.vertices = real_vertices_;
  figures.triangles = topology().triangle_count();
  figures.edges = topology().edge_count();
  figures.border_edges = topology().border_edge_count();
  figures.rim_length_m = CalcRimLength();
  if (figures.edges > 0)
    figures.completeness = 1.0 - static_cast<double>(figures.border_edges) / static_cast<double>(figures.edges);
  return figures;
}

}  // namespace nbs
