#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/mesher/brick_grid.h"
#include "services/mesher/measurement_map.h"
#include "services/mesher/paged_vector.h"

namespace nbs {

/// One vertex of the mesh, or a point that may become one.
struct Vertex {
  enum class State : uint8_t {
    kFree,     ///< The slot holds nothing.
    kPending,  ///< A measured point that keeps its distance from all others, waiting for support.
    kReal,     ///< Has a surface; may be in triangles.
  };
  enum class Ridge : uint8_t {
    kNone,    ///< Lies on the fitted surface.
    kBeside,  ///< Moved onto a plane that ends in a sharp ridge.
    kOn,      ///< Moved onto, or founded on, a sharp ridge.
    kLoose,   ///< Was on one and looks for its place anew.
  };
  // What searches read comes first.
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();  ///< Metres.
  int32_t next_in_cell = BrickGrid::kNone;
  /// Unit, towards the side that was seen. While pending, the sum of the unit directions from which it was measured.
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();
  State state = State::kFree;
  Ridge ridge : 4 = Ridge::kNone;
  bool fit_due : 1 = false;      ///< Measurements came near since the surface was fitted.
  bool star_due : 1 = false;     ///< The vertex or its surroundings changed since the star was made.
  bool publish_due : 1 = false;  ///< Something changed since it was published.
  bool published : 1 = false;
  uint16_t curvature_per_m = 0;  ///< Of the fitted surface.
  uint16_t support = 0;          ///< Measurements that carried the last fit,
  uint16_t fresh = 0;            ///< and those that came near since; 65535 of either at most.
  uint16_t measurements = 0;     ///< Its own: those to which it was the nearest vertex; 65535 at most.
  /// Normal at which the stars around it were made, in 1/32767.
  std::array<int16_t, 3> star_normal_W{};
  /// Fixed point through which the vertex moves along its normal, metres.
  Eigen::Vector3f anchor_W = Eigen::Vector3f::Zero();
  Eigen::Vector3f star_p_W = Eigen::Vector3f::Zero();       ///< Position at which the stars around it were made.
  Eigen::Vector3f published_p_W = Eigen::Vector3f::Zero();  ///< Position as last published.
  float information = 0.0f;                                 ///< Sum of 1/sigma^2 of its own measurements, 1/m^2.
  float best_cosine = -1.0f;                                ///< Of the incidence.
  uint16_t first_scan = 0;
  uint16_t last_scan = 0;
};
static_assert(sizeof(Vertex) <= 92, "most of the mesher's memory is vertices");

/// The vertices by number, and by place. Numbers are reused, last freed first.
class VertexStore {
 public:
  /// @param cell_m  Edge of a cell of the search grid, metres.
  explicit VertexStore(float cell_m) : grid_(cell_m) {}

  /// Makes a pending vertex at a measured point and returns its number.
  uint32_t Insert(const Measurement& m, int32_t scan);
  void Remove(uint32_t id);
  /// Moves a vertex to p_W.
  void Move(uint32_t id, const Eigen::Vector3f& p_W);

  const Vertex& operator[](uint32_t id) const { return vertices_[id]; }
  Vertex& operator[](uint32_t id) { return vertices_[id]; }
  /// One past the largest number in use so far.
  uint32_t size() const { return static_cast<uint32_t>(vertices_.size()); }

  /// Calls visit(id) for each vertex in the cells that meet the cube of half edge radius_m about p_W; some lie further
  /// away than the radius.
  template <typename Visit>
  void ForEachNear(const Eigen::Vector3f& p_W, float radius_m, Visit&& visit) const {
    grid_.ForEachCell(p_W, radius_m, [&](int32_t head) {
      for (int32_t i = head; i != BrickGrid::kNone; i = vertices_[i].next_in_cell) visit(static_cast<uint32_t>(i));
    });
  }

 private:
  void Link(uint32_t id);
  void Unlink(uint32_t id);

  BrickGrid grid_;
  PagedVector<Vertex> vertices_;
  std::vector<uint32_t> free_;
};

}  // namespace nbs
