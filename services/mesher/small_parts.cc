#include "services/mesher/small_parts.h"

#include <algorithm>

namespace nbs {
namespace {

/// The fan that ends (counter-clockwise) with the border edge from the vertex to `last`, walked clockwise.
std::vector<uint32_t> CollectFan(const MeshTopology& mesh, uint32_t vertex, uint32_t last) {
  std::vector<uint32_t> fan;
  uint32_t slot = mesh.Find(last, vertex);
  while (slot != MeshTopology::kNone) {
    fan.push_back(slot);
    slot = mesh.Find(mesh.Next(slot, vertex), vertex);
  }
  return fan;
}

bool IsLarger(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  if (a.size() != b.size()) return a.size() > b.size();
  return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
}

}  // namespace

std::vector<uint32_t> FindLesserFans(const MeshTopology& mesh, uint32_t vertex) {
  if (!mesh.IsOnBorder(vertex)) return {};
  std::vector<uint32_t> successors;
  mesh.FindBorderSuccessors(vertex, successors);
  if (successors.size() == 1 && CollectFan(mesh, vertex, successors[0]).size() == mesh.CountTrianglesAt(vertex))
    return {};
  std::vector<uint32_t> largest;
  for (uint32_t last : successors) {
    std::vector<uint32_t> fan = CollectFan(mesh, vertex, last);
    if (largest.empty() || IsLarger(fan, largest)) largest.swap(fan);
  }
  std::vector<uint32_t> lesser;
  for (uint32_t slot : mesh.TrianglesAt(vertex)) {
    if (std::find(largest.begin(), largest.end(), slot) == largest.end()) lesser.push_back(slot);
  }
  std::sort(lesser.begin(), lesser.end());
  return lesser;
}

std::vector<uint32_t> FindPart(const MeshTopology& mesh, uint32_t start, size_t limit) {
  std::vector<uint32_t> part{start};
  for (size_t i = 0; i < part.size(); ++i) {
    const MeshTopology::Triangle t = mesh.triangles()[part[i]];
    for (int k = 0; k < 3; ++k) {
      if (part.size() == limit) return part;
      const uint32_t neighbour = mesh.Find(t[(k + 1) % 3], t[k]);
      if (neighbour != MeshTopology::kNone && std::find(part.begin(), part.end(), neighbour) == part.end())
        part.push_back(neighbour);
    }
  }
  return part;
}

}  // namespace nbs
