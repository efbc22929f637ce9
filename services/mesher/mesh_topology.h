#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace nbs {

/// Triangles over numbered vertices, in numbered slots: an oriented manifold with border at any time, since a directed
/// edge belongs to one triangle at most. Counts edges and border edges as triangles come and go.
class MeshTopology {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr int kMaxTrianglesPerVertex = 28;
  using Triangle = std::array<uint32_t, 3>;

  /// Adds the triangle and returns its slot; kNone if one of its directed edges is taken, two vertices are equal or a
  /// vertex has its fill of triangles.
  ///
  /// @param group  Any number of the caller's; group() gives it back.
  uint32_t Insert(const Triangle& t, int32_t group);
  void Remove(uint32_t slot);

  /// Slot of the triangle that has the directed edge from a to b; kNone if there is none.
  uint32_t Find(uint32_t a, uint32_t b) const;

  /// By slot; an empty slot has three equal vertices.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  int32_t group(uint32_t slot) const { return groups_[slot]; }
  bool IsEmpty(uint32_t slot) const { return triangles_[slot][0] == triangles_[slot][1]; }

  /// Slots of the triangles at a vertex, in no particular order that matters.
  std::span<const uint32_t> TrianglesAt(uint32_t vertex) const;

  /// The vertex that comes after, or before, `vertex` in the triangle.
  uint32_t Next(uint32_t slot, uint32_t vertex) const;
  uint32_t Previous(uint32_t slot, uint32_t vertex) const;

  /// The vertices to which a border runs from `vertex`, walking with the gap on the left.
  void FindBorderSuccessors(uint32_t vertex, std::vector<uint32_t>& successors) const;

  int64_t triangle_count() const { return triangle_count_; }
  int64_t border_edge_count() const { return border_edge_count_; }
  int64_t edge_count() const { return (3 * triangle_count_ + border_edge_count_) / 2; }

  /// Slots that changed since the last call, ascending, each once.
  std::vector<uint32_t> TakeChangedSlots();

 private:
  struct Fan {
    std::array<uint32_t, kMaxTrianglesPerVertex> slots;
    uint8_t size = 0;
  };

  void MarkChanged(uint32_t slot);

  std::vector<Triangle> triangles_;
  std::vector<int32_t> groups_;
  std::vector<uint8_t> changed_;
  std::vector<uint32_t> changed_list_;
  std::vector<uint32_t> free_;
  std::vector<Fan> fans_;
  int64_t triangle_count_ = 0;
  int64_t border_edge_count_ = 0;
};

}  // namespace nbs
