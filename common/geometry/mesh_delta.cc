#include "common/geometry/mesh_delta.h"

#include <stdexcept>
#include <string>

namespace nbs {
namespace {

constexpr uint32_t kMaxSlots = 1u << 28;

void CheckSlot(uint32_t id) {
  if (id >= kMaxSlots)
    throw std::invalid_argument("MeshReplica: slot number " + std::to_string(id) + " is out of range");
}

}  // namespace

void MeshReplica::Apply(const MeshDelta& delta) {
  for (const MeshVertex& v : delta.vertices) {
    CheckSlot(v.id);
    if (v.id >= vertices_.size()) vertices_.resize(v.id + 1);
    vertices_[v.id] = v;
  }
  for (const MeshTriangle& t : delta.triangles) {
    CheckSlot(t.id);
    for (uint32_t v : t.vertices) CheckSlot(v);
    if (t.id >= triangles_.size()) triangles_.resize(t.id + 1);
    triangles_[t.id] = t.vertices;
  }
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
