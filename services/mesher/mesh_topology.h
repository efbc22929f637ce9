#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "services/mesher/paged_vector.h"

namespace nbs {

/// Triangles over numbered vertices, in numbered slots: an oriented manifold with border at any time, since a directed
/// edge belongs to one triangle at most. Counts edges and border edges as triangles come and go.
class MeshTopology {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  using Triangle = std::array<uint32_t, 3>;

  /// Adds the triangle and returns its slot; kNone if one of its directed edges is taken or two vertices are
  /// equal.
  ///
  /// @param group  Any number of the caller's; group() gives it back.
  uint32_t Insert(const Triangle& t, int32_t group);
  void Remove(uint32_t slot);

  /// Slot of the triangle that has the directed edge from a to b; kNone if there is none.
  uint32_t Find(uint32_t a, uint32_t b) const;

  /// By slot; an empty slot has three equal vertices.
  class TriangleList;
  TriangleList triangles() const;
  int32_t group(uint32_t slot) const { return slots_[slot].group; }
  bool IsEmpty(uint32_t slot) const { return slots_[slot].triangle[0] == slots_[slot].triangle[1]; }

  /// The slots of the triangles at a vertex, one after the other: in no particular order, but the same one whenever the
  /// same triangles have come and gone. To be read while no triangle comes or goes.
  class TriangleRange {
   public:
    class Iterator {
     public:
      Iterator(const MeshTopology* mesh, uint32_t vertex, uint32_t slot) : mesh_(mesh), vertex_(vertex), slot_(slot) {}
      uint32_t operator*() const { return slot_; }
      Iterator& operator++() {
        slot_ = mesh_->slots_[slot_].next[CornerOf(mesh_->slots_[slot_].triangle, vertex_)];
        return *this;
      }
      bool operator!=(const Iterator& other) const { return slot_ != other.slot_; }

     private:
      const MeshTopology* mesh_;
      uint32_t vertex_, slot_;
    };
    TriangleRange(const MeshTopology* mesh, uint32_t vertex, uint32_t first)
        : mesh_(mesh), vertex_(vertex), first_(first) {}
    Iterator begin() const { return {mesh_, vertex_, first_}; }
    Iterator end() const { return {mesh_, vertex_, kNone}; }
    bool empty() const { return first_ == kNone; }

   private:
    const MeshTopology* mesh_;
    uint32_t vertex_, first_;
  };
  TriangleRange TrianglesAt(uint32_t vertex) const {
    return {this, vertex, vertex < first_.size() ? first_[vertex].slot : kNone};
  }
  size_t CountTrianglesAt(uint32_t vertex) const;

  /// The vertex that comes after, or before, `vertex` in the triangle.
  uint32_t Next(uint32_t slot, uint32_t vertex) const;
  uint32_t Previous(uint32_t slot, uint32_t vertex) const;

  /// Border edges that begin at the vertex.
  int CountBordersFrom(uint32_t vertex) const { return vertex < borders_.size() ? borders_[vertex] : 0; }
  bool IsOnBorder(uint32_t vertex) const { return CountBordersFrom(vertex) != 0; }

  /// The vertices to which a border runs from `vertex`, walking with the gap on the left.
  void FindBorderSuccessors(uint32_t vertex, std::vector<uint32_t>& successors) const;

  /// Calls visit(a, b) for each border edge, from a to b with the gap on the left, in ascending order of a. What it
  /// takes grows with the border, and with what has changed since the call before, not with the mesh.
  template <typename Visit>
  void ForEachBorderEdge(Visit&& visit);

  int64_t triangle_count() const { return triangle_count_; }
  int64_t border_edge_count() const { return border_edge_count_; }
  int64_t edge_count() const { return (3 * triangle_count_ + border_edge_count_) / 2; }

  /// Slots that changed since the last call, ascending, each once.
  std::vector<uint32_t> TakeChangedSlots();

 private:
  struct Slot {
    Triangle triangle{};
    std::array<uint32_t, 3> next{};  ///< By corner: the next slot in the list of the vertex there.
    int32_t group = 0;
  };
  /// Beginning of the list of a vertex's triangles.
  struct First {
    uint32_t slot = kNone;
  };

  static int CornerOf(const Triangle& t, uint32_t vertex) { return t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2; }
  void Link(uint32_t slot);
  void Unlink(uint32_t slot);
  void CountBorders(const Triangle& t, int change);
  void MarkChanged(uint32_t slot);
  void MarkNearBorder(uint32_t vertex);

  PagedVector<Slot> slots_;
  PagedVector<First> first_;
  PagedVector<uint8_t> borders_;       // Border edges that begin at each vertex,
  PagedVector<uint32_t> border_ends_;  // and the exclusive or of the vertices where they end.
  std::vector<bool> changed_;
  std::vector<uint32_t> changed_list_;
  std::vector<uint32_t> free_;
  // All vertices on the border are listed, and some that no longer are.
  std::vector<bool> near_border_;
  std::vector<uint32_t> near_border_list_;
  int64_t triangle_count_ = 0;
  int64_t border_edge_count_ = 0;
};

/// The triangles by slot, to be read.
class MeshTopology::TriangleList {
 public:
  explicit TriangleList(const MeshTopology* mesh) : mesh_(mesh) {}
  size_t size() const { return mesh_->slots_.size(); }
  bool empty() const { return size() == 0; }
  const Triangle& operator[](size_t slot) const { return mesh_->slots_[slot].triangle; }

  class Iterator {
   public:
    Iterator(const MeshTopology* mesh, size_t slot) : mesh_(mesh), slot_(slot) {}
    const Triangle& operator*() const { return mesh_->slots_[slot_].triangle; }
    Iterator& operator++() {
      ++slot_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return slot_ != other.slot_; }

   private:
    const MeshTopology* mesh_;
    size_t slot_;
  };
  Iterator begin() const { return {mesh_, 0}; }
  Iterator end() const { return {mesh_, size()}; }

 private:
  const MeshTopology* mesh_;
};

inline MeshTopology::TriangleList MeshTopology::triangles() const { return TriangleList(this); }

template <typename Visit>
void MeshTopology::ForEachBorderEdge(Visit&& visit) {
  std::vector<uint32_t> successors, list;
  list.swap(near_border_list_);
  std::sort(list.begin(), list.end());
  for (uint32_t vertex : list) {
    FindBorderSuccessors(vertex, successors);
    near_border_[vertex] = !successors.empty();
    if (!successors.empty()) near_border_list_.push_back(vertex);
    for (uint32_t next : successors) visit(vertex, next);
  }
}

}  // namespace nbs
