// Sharp ridges, at the end of each scan.

#include <algorithm>
#include <iterator>

#include "services/mesher/sort_unique.h"
#include "services/mesher/streaming_mesher.h"

namespace nbs {

void StreamingMesher::SharpenRidges() {
  std::vector<uint32_t> due;
  due.swap(ridge_due_);
  SortUnique(due);
  const std::vector<RidgeSharpener::Place> before = Loosen(due);
  ridge_due_.clear();
  const RidgeSharpener::Changes changes =
      RidgeSharpener(measurements_, triangulation_, settings_.ridges, vertices_).Sharpen(due, before);
  real_vertices_ += static_cast<int64_t>(changes.founded.size());
  for (uint32_t id : changes.founded) {
    MarkStarsAround(id);
    MarkForPublishing(id);
  }
  std::vector<uint32_t> moved;
  std::set_union(due.begin(), due.end(), changes.moved.begin(), changes.moved.end(), std::back_inserter(moved));
  for (uint32_t id : moved) {
    MarkIfMoved(id);
    MarkForPublishing(id);
  }
  star_queue_.TakeAll(due_);
  TriangulateDueVertices();
}

/// Puts those that lie on or beside ridges back onto the fitted surface; tells where they were.
std::vector<RidgeSharpener::Place> StreamingMesher::Loosen(std::span<const uint32_t> ids) {
  std::vector<RidgeSharpener::Place> places;
  for (uint32_t id : ids) {
    Vertex& v = vertices_[id];
    if (v.ridge == Vertex::Ridge::kNone) continue;
    const bool on_ridge = v.ridge == Vertex::Ridge::kOn;
    if (on_ridge) places.push_back({id, {v.p_W, v.normal_W}});
    v.ridge = on_ridge ? Vertex::Ridge::kLoose : Vertex::Ridge::kNone;
    Refit(id);
  }
  return places;
}

}  // namespace nbs
