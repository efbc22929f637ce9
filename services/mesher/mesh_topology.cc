#include "services/mesher/mesh_topology.h"

#include <algorithm>

namespace nbs {

uint32_t MeshTopology::Insert(const Triangle& t, int32_t group) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return kNone;
  const uint32_t largest = *std::max_element(t.begin(), t.end());
  if (largest >= fans_.size()) fans_.resize(largest + 1);
  for (int i = 0; i < 3; ++i) {
    if (fans_[t[i]].size == kMaxTrianglesPerVertex || Find(t[i], t[(i + 1) % 3]) != kNone) return kNone;
  }
  for (int i = 0; i < 3; ++i) border_edge_count_ += Find(t[(i + 1) % 3], t[i]) == kNone ? 1 : -1;
  uint32_t slot = static_cast<uint32_t>(triangles_.size());
  if (free_.empty()) {
    triangles_.push_back(t);
    groups_.push_back(group);
    changed_.push_back(0);
  } else {
    slot = free_.back();
    free_.pop_back();
    triangles_[slot] = t;
    groups_[slot] = group;
  }
  for (uint32_t v : t) fans_[v].slots[fans_[v].size++] = slot;
  ++triangle_count_;
  MarkChanged(slot);
  return slot;
}

void MeshTopology::Remove(uint32_t slot) {
  const Triangle t = triangles_[slot];
  for (uint32_t v : t) {
    Fan& fan = fans_[v];
    *std::find(fan.slots.begin(), fan.slots.begin() + fan.size, slot) = fan.slots[fan.size - 1];
    --fan.size;
  }
  for (int i = 0; i < 3; ++i) border_edge_count_ += Find(t[(i + 1) % 3], t[i]) == kNone ? -1 : 1;
  triangles_[slot] = {0, 0, 0};
  free_.push_back(slot);
  --triangle_count_;
  MarkChanged(slot);
}

uint32_t MeshTopology::Find(uint32_t a, uint32_t b) const {
  for (uint32_t slot : TrianglesAt(a)) {
    if (Next(slot, a) == b) return slot;
  }
  return kNone;
}

std::span<const uint32_t> MeshTopology::TrianglesAt(uint32_t vertex) const {
  if (vertex >= fans_.size()) return {};
  return {fans_[vertex].slots.data(), fans_[vertex].size};
}

uint32_t MeshTopology::Next(uint32_t slot, uint32_t vertex) const {
  const Triangle& t = triangles_[slot];
  return t[0] == vertex ? t[1] : t[1] == vertex ? t[2] : t[0];
}

uint32_t MeshTopology::Previous(uint32_t slot, uint32_t vertex) const {
  const Triangle& t = triangles_[slot];
  return t[0] == vertex ? t[2] : t[1] == vertex ? t[0] : t[1];
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
  for (uint32_t slot : list) changed_[slot] = 0;
  return list;
}

void MeshTopology::MarkChanged(uint32_t slot) {
  if (changed_[slot] != 0) return;
  changed_[slot] = 1;
  changed_list_.push_back(slot);
}

}  // namespace nbs
