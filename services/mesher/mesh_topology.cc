#include "services/mesher/mesh_topology.h"

#include <utility>

namespace nbs {

uint32_t MeshTopology::Insert(const Triangle& t, int32_t group) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return kNone;
  for (int i = 0; i < 3; ++i) {
    if (Find(t[i], t[(i + 1) % 3]) != kNone) return kNone;
  }
  const size_t vertices = std::max({t[0], t[1], t[2]}) + size_t{1};
  first_.GrowTo(vertices);
  borders_.GrowTo(vertices);
  border_ends_.GrowTo(vertices);
  CountBorders(t, 1);
  uint32_t slot = static_cast<uint32_t>(slots_.size());
  if (free_.empty()) {
    slots_.Append();
    changed_.push_back(false);
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  slots_[slot].triangle = t;
  slots_[slot].group = group;
  Link(slot);
  ++triangle_count_;
  MarkChanged(slot);
  return slot;
}

void MeshTopology::Remove(uint32_t slot) {
  const Triangle t = slots_[slot].triangle;
  Unlink(slot);
  CountBorders(t, -1);
  slots_[slot].triangle = {0, 0, 0};
  free_.push_back(slot);
  --triangle_count_;
  MarkChanged(slot);
}

/// The triangle, which is not in the lists, comes (1) or goes (-1): each of its edges makes a border edge where it has
/// no triangle beside it, and takes one away where it has.
void MeshTopology::CountBorders(const Triangle& t, int change) {
  for (int i = 0; i < 3; ++i) {
    uint32_t begin = t[(i + 1) % 3], end = t[i];
    const bool beside = Find(begin, end) != kNone;
    if (beside) std::swap(begin, end);
    border_edge_count_ += beside ? -change : change;
    borders_[begin] = static_cast<uint8_t>(borders_[begin] + (beside ? -change : change));
    border_ends_[begin] ^= end;
  }
}

void MeshTopology::Link(uint32_t slot) {
  Slot& own = slots_[slot];
  const Triangle& t = own.triangle;
  for (int i = 0; i < 3; ++i) {
    own.next[i] = first_[t[i]].slot;
    first_[t[i]].slot = slot;
    MarkNearBorder(t[i]);
  }
}

void MeshTopology::Unlink(uint32_t slot) {
  const Slot& own = slots_[slot];
  for (int i = 0; i < 3; ++i) {
    const uint32_t vertex = own.triangle[i];
    uint32_t* link = &first_[vertex].slot;
    while (*link != slot) {
      Slot& before = slots_[*link];
      link = &before.next[CornerOf(before.triangle, vertex)];
    }
    *link = own.next[i];
    MarkNearBorder(vertex);
  }
}

uint32_t MeshTopology::Find(uint32_t a, uint32_t b) const {
  uint32_t slot = a < first_.size() ? first_[a].slot : kNone;
  while (slot != kNone) {
    const Slot& own = slots_[slot];
    const int corner = CornerOf(own.triangle, a);
    if (own.triangle[corner == 2 ? 0 : corner + 1] == b) return slot;
    slot = own.next[corner];
  }
  return kNone;
}

size_t MeshTopology::CountTrianglesAt(uint32_t vertex) const {
  size_t count = 0;
  for (auto it = TrianglesAt(vertex).begin(); it != TrianglesAt(vertex).end(); ++it) ++count;
  return count;
}

uint32_t MeshTopology::Next(uint32_t slot, uint32_t vertex) const {
  const Triangle& t = slots_[slot].triangle;
  return t[(CornerOf(t, vertex) + 1) % 3];
}

uint32_t MeshTopology::Previous(uint32_t slot, uint32_t vertex) const {
  const Triangle& t = slots_[slot].triangle;
  return t[(CornerOf(t, vertex) + 2) % 3];
}

void MeshTopology::FindBorderSuccessors(uint32_t vertex, std::vector<uint32_t>& successors) const {
  successors.clear();
  if (!IsOnBorder(vertex)) return;
  if (borders_[vertex] == 1) {
    successors.push_back(border_ends_[vertex]);
    return;
  }
  // A triangle ends a fan if none at the vertex begins where it ends.
  std::vector<uint32_t>& ends = successors;
  std::array<uint32_t, 32> begins{};
  size_t count = 0;
  for (uint32_t slot : TrianglesAt(vertex)) {
    const Triangle& t = slots_[slot].triangle;
    const int corner = CornerOf(t, vertex);
    ends.push_back(t[(corner + 2) % 3]);
    if (count < begins.size()) begins[count] = t[(corner + 1) % 3];
    ++count;
  }
  if (count > begins.size()) {
    std::erase_if(ends, [&](uint32_t end) { return Find(vertex, end) != kNone; });
  } else {
    const auto last = begins.begin() + static_cast<std::ptrdiff_t>(count);
    std::erase_if(ends, [&](uint32_t end) { return std::find(begins.begin(), last, end) != last; });
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
