#include "services/mesher/vertex_store.h"

namespace nbs {

uint32_t VertexStore::Insert(const Measurement& m, int32_t scan) {
  uint32_t id = size();
  if (free_.empty()) {
    vertices_.Append();
  } else {
    id = free_.back();
    free_.pop_back();
  }
  Vertex& v = vertices_[id];
  v = Vertex{};
  v.state = Vertex::State::kPending;
  v.anchor_W = v.p_W = m.p_W;
  v.first_scan = v.last_scan = static_cast<uint16_t>(scan);
  Link(id);
  return id;
}

void VertexStore::Remove(uint32_t id) {
  Unlink(id);
  vertices_[id] = Vertex{};
  free_.push_back(id);
}

void VertexStore::Move(uint32_t id, const Eigen::Vector3f& p_W) {
  Unlink(id);
  vertices_[id].p_W = p_W;
  Link(id);
}

void VertexStore::Link(uint32_t id) {
  int32_t& head = grid_.Touch(vertices_[id].p_W);
  vertices_[id].next_in_cell = head;
  head = static_cast<int32_t>(id);
}

void VertexStore::Unlink(uint32_t id) {
  const Eigen::Vector3f& p_W = vertices_[id].p_W;
  const int32_t next = vertices_[id].next_in_cell;
  int32_t i = grid_.Find(p_W);
  if (i == static_cast<int32_t>(id)) {
    if (next == BrickGrid::kNone) {
      grid_.Clear(p_W);
    } else {
      grid_.Touch(p_W) = next;
    }
    return;
  }
  while (vertices_[i].next_in_cell != static_cast<int32_t>(id)) i = vertices_[i].next_in_cell;
  vertices_[i].next_in_cell = next;
}

}  // namespace nbs
