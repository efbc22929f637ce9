#include "services/mesher/mesh_topology.h"

namespace nbs {

uint32_t MeshTopology::Insert(const Triangle& t, int32_t group) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return kNone;
  for (int i = 0; i < 3; ++i) {
    if (Find(t[i], t[(i + 1) % 3]) != kNone) return kNone;
  }
  for (int i = 0; i < 3; ++i) border_edge_count_ += Find(t[(i + 1) % 3], t[i]) == kNone ? 1 : -1;
  uint32_t slot = static_cast<uint32_t>(triangles_.size());
  if (free_.empty()) {
    triangles_.push_back(t);
    links_.push_back({});
    changed_.push_back(false);
  } else {
    slot = free_.back();
    free_.pop_back();
    triangles_[slot] = t;
  }
  links_[slot].group = group;
  Link(slot);
  ++triangle_count_;
  MarkChanged(slot);
  return slot;
}

void MeshTopology::Remove(uint32_t slot) {
  const Triangle t = triangles_[slot];
  Unlink(slot);
  for (int i = 0; i < 3; ++i) border_edge_count_ += Find(t[(i + 1) % 3], t[i]) == kNone ? -1 : 1;
  triangles_[slot] = {0, 0, 0};
  free_.push_back(slot);
  --triangle_count_;
  MarkChanged(slot);
}

void MeshTopology::Link(uint32_t slot) {
  const Triangle& t = triangles_[slot];
  first_.GrowTo(std::max({t[0], t[1], t[2]}) + size_t{1});
  for (int i = 0; i < 3; ++i) {
    links_[slot].next[i] = first_[t[i]].slot;
    first_[t[i]].slot = slot;
    MarkNearBorder(t[i]);
  }
}

void MeshTopology::Unlink(uint32_t slot) {
  const Triangle& t = triangles_[slot];
  for (int i = 0; i < 3; ++i) {
    uint32_t* link = &first_[t[i]].slot;
    while (*link != slot) link = &links_[*link].next[CornerOf(*link, t[i])];
    *link = links_[slot].next[i];
    MarkNearBorder(t[i]);
  }
}

uint32_t MeshTopology::Find(uint32_t a, uint32_t b) const {
  for (uint32_t slot : TrianglesAt(a)) {
    if (Next(slot, a) == b) return slot;
  }
  return kNone;
}

size_t MeshTopology::CountTrianglesAt(uint32_t vertex) const {
  size_t count = 0;
  for (auto it = TrianglesAt(vertex).begin(); it != TrianglesAt(vertex).end(); ++it) ++count;
  return count;
}

uint32_t MeshTopology::Next(uint32_t slot, uint32_t vertex) const {
  return triangles_[slot][(CornerOf(slot, vertex) + 1) % 3];
}

uint32_t MeshTopology::Previous(uint32_t slot, uint32_t vertex) const {
  return triangles_[slot][(CornerOf(slot, vertex) + 2) % 3];
}

void MeshTopology::FindBorderSuccessors(uint32_t vertex, std::vector<uint32_t>& successors) const {
  successors.clear();
  for (uint32_t slot : TrianglesAt(vertex)) {
    const uint32_t previous = Previous(slot, vertex);
    if (Find(vertex, previous) == kNone) successors.push_back(previous);
  }
}

std::vector<uint32_t> MeshTopology::TakeChangedSlots() {
  std::vector<uint32_t> list;
  list.swap(changed_list_);
  std::sort(list.begin(), list.end());
  for (uint32_t slot : list) changed_[slot] = false;
  return list;
}

void MeshTopology::MarkChanged(uint32_t slot) {
  if (changed_[slot]) return;
  changed_[slot] = true;
  changed_list_.push_back(slot);
}

void MeshTopology::MarkNearBorder(uint32_t vertex) {
  if (vertex >= near_border_.size()) near_border_.resize(vertex + 1, false);
  if (near_border_[vertex]) return;
  near_border_[vertex] = true;
  near_border_list_.push_back(vertex);
}

}  // namespace nbs
