#include "common/geometry/mesh_delta.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

/// How many slots there are once a delta's elements are in.
template <typename Element>
size_t FindEnd(size_t end, const std::vector<Element>& elements) {
  const size_t furthest = end + elements.size() + kMaxSlotGap;
  for (const Element& element : elements) {
    if (element.id >= kMaxSlots || element.id >= furthest)
      throw std::invalid_argument("MeshReplica: slot number " + std::to_string(element.id) + " is out of range");
    end = std::max<size_t>(end, element.id + 1);
  }
  return end;
}

void CheckCorners(const std::vector<MeshTriangle>& triangles, size_t vertices) {
  for (const MeshTriangle& t : triangles) {
    if (MeshReplica::IsEmpty(t.vertices)) continue;
    for (uint32_t v : t.vertices) {
      if (v >= vertices) {
        throw std::invalid_argument("MeshReplica: triangle " + std::to_string(t.id) + " names vertex " +
                                    std::to_string(v) + ", which is not there");
      }
    }
  }
}

}  // namespace

void MeshReplica::Apply(const MeshDelta& delta) {
  const size_t vertices = FindEnd(vertices_.size(), delta.vertices);
  const size_t triangles = FindEnd(triangles_.size(), delta.triangles);
  CheckCorners(delta.triangles, vertices);
  vertices_.resize(vertices);
  triangles_.resize(triangles);
  for (const MeshVertex& v : delta.vertices) vertices_[v.id] = v;
  for (const MeshTriangle& t : delta.triangles) triangles_[t.id] = t.vertices;
}

std::vector<uint32_t> MeshReplica::FindUsedVertices() const {
  std::vector<bool> is_used(vertices_.size(), false);
  for (const auto& t : triangles_) {
    if (IsEmpty(t)) continue;
    for (uint32_t v : t) is_used.at(v) = true;
  }
  std::vector<uint32_t> used;
  for (size_t v = 0; v < vertices_.size(); ++v) {
    if (is_used[v]) used.push_back(static_cast<uint32_t>(v));
  }
  return used;
}

TriangleMesh MeshReplica::MakeCompactMesh() const {
  TriangleMesh mesh;
  std::vector<uint32_t> compact(vertices_.size(), 0);
  for (uint32_t v : FindUsedVertices()) {
    compact[v] = static_cast<uint32_t>(mesh.vertices_W.size());
    mesh.vertices_W.push_back(vertices_[v].p_W);
    mesh.normals_W.push_back(vertices_[v].normal_W);
  }
  for (const auto& t : triangles_) {
    if (!IsEmpty(t)) mesh.triangles.push_back({compact[t[0]], compact[t[1]], compact[t[2]]});
  }
  return mesh;
}

}  // namespace nbs
