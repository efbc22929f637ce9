#include "services/mesher/loop_filling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace nbs {
namespace {

constexpr float kImpossible = std::numeric_limits<float>::infinity();

/// Of unit length; nothing is a triangle whose height is below a hundredth of its longest side.
bool CalcTriangleNormal(const SurfaceCorner& a, const SurfaceCorner& b, const SurfaceCorner& c,
                        Eigen::Vector3f& normal_W) {
  const Eigen::Vector3f u = b.p_W - a.p_W, v = c.p_W - a.p_W;
  normal_W = u.cross(v);
  const float size = normal_W.norm();
  constexpr float kLeastHeight = 0.01f;
  if (!(size > kLeastHeight * std::max({u.squaredNorm(), v.squaredNorm(), (v - u).squaredNorm()}))) return false;
  normal_W /= size;
  return true;
}

/// The normals at a ridge stand across its triangles, give or take their error; no triangle turns away from a corner
/// further than that.
bool StandsOnNoHead(const Eigen::Vector3f& normal_W, const SurfaceCorner& a, const SurfaceCorner& b,
                    const SurfaceCorner& c) {
  constexpr float kLeastCosine = -0.5f;
  return normal_W.dot(a.normal_W) > kLeastCosine && normal_W.dot(b.normal_W) > kLeastCosine &&
         normal_W.dot(c.normal_W) > kLeastCosine;
}

bool FacesMean(const Eigen::Vector3f& normal_W, const SurfaceCorner& a, const SurfaceCorner& b,
               const SurfaceCorner& c) {
  constexpr float kLeastCosine = 0.2f;
  const Eigen::Vector3f sum_W = a.normal_W + b.normal_W + c.normal_W;
  return normal_W.dot(sum_W) > kLeastCosine * sum_W.norm();
}

/// Twice the area of the loop as a vector (Newell); zero if it runs the wrong way round.
Eigen::Vector3f CalcLoopNormal(std::span<const SurfaceCorner> corners) {
  Eigen::Vector3f area = Eigen::Vector3f::Zero(), normals = Eigen::Vector3f::Zero();
  for (size_t i = 0; i < corners.size(); ++i) {
    area += (corners[i].p_W - corners[0].p_W).cross(corners[(i + 1) % corners.size()].p_W - corners[0].p_W);
    normals += corners[i].normal_W;
  }
  return area.dot(normals) > 0.0f ? area.normalized() : Eigen::Vector3f::Zero();
}

/// Least costs of the parts of a loop that a diagonal cuts off.
class LoopTable {
 public:
  LoopTable(std::span<const SurfaceCorner> corners, const std::function<bool(uint32_t, uint32_t)>& may_join)
      : corners_(corners),
        size_(static_cast<uint32_t>(corners.size())),
        normal_W_(CalcLoopNormal(corners)),
        cells_(size_ * size_) {
    for (uint32_t span = 2; span < size_; ++span) {
      for (uint32_t i = 0; i + span < size_; ++i) {
        const uint32_t j = i + span;
        if (span + 1 == size_ || may_join(i, j)) Solve(i, j);
      }
    }
  }

  bool IsSolved() const { return CostOf(0, size_ - 1) < kImpossible; }

  void Collect(uint32_t i, uint32_t j, std::vector<std::array<uint32_t, 3>>& triangles) const {
    if (j < i + 2) return;
    const uint32_t k = cells_[i * size_ + j].middle;
    Collect(i, k, triangles);
    triangles.push_back({i, k, j});
    Collect(k, j, triangles);
  }

 private:
  struct Cell {
    float cost = kImpossible;
    uint32_t middle = 0;
  };

  float CostOf(uint32_t i, uint32_t j) const { return j == i + 1 ? 0.0f : cells_[i * size_ + j].cost; }

  void Solve(uint32_t i, uint32_t j) {
    Cell& cell = cells_[i * size_ + j];
    const float own = (corners_[i].p_W - corners_[j].p_W).squaredNorm();
    for (uint32_t k = i + 1; k < j; ++k) {
      const float cost = CostOf(i, k) + CostOf(k, j) + own;
      if (cost < cell.cost && FacesLoop(i, k, j)) cell = {cost, k};
    }
  }

  /// Towards the side of the whole loop, or, where the loop lies around a rim, of its own corners.
  bool FacesLoop(uint32_t i, uint32_t k, uint32_t j) const {
    constexpr float kLeastCosine = 0.1f;
    const SurfaceCorner &a = corners_[i], &b = corners_[k], &c = corners_[j];
    Eigen::Vector3f normal_W;
    if (normal_W_.isZero() || !CalcTriangleNormal(a, b, c, normal_W) || !StandsOnNoHead(normal_W, a, b, c))
      return false;
    return normal_W.dot(normal_W_) > kLeastCosine || FacesMean(normal_W, a, b, c);
  }

  std::span<const SurfaceCorner> corners_;
  uint32_t size_;
  Eigen::Vector3f normal_W_;
  std::vector<Cell> cells_;
};

}  // namespace

bool FacesItsNormals(const SurfaceCorner& a, const SurfaceCorner& b, const SurfaceCorner& c) {
  Eigen::Vector3f normal_W;
  return CalcTriangleNormal(a, b, c, normal_W) && FacesMean(normal_W, a, b, c) && StandsOnNoHead(normal_W, a, b, c);
}

std::vector<std::array<uint32_t, 3>> TriangulateLoop(std::span<const SurfaceCorner> corners,
                                                     const std::function<bool(uint32_t, uint32_t)>& may_join) {
  std::vector<std::array<uint32_t, 3>> triangles;
  if (corners.size() < 3) return triangles;
  const LoopTable table(corners, may_join);
  if (table.IsSolved()) table.Collect(0, static_cast<uint32_t>(corners.size()) - 1, triangles);
  return triangles;
}

}  // namespace nbs
