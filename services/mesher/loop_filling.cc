#include "services/mesher/loop_filling.h"

#include <Eigen/Geometry>
#include <limits>

namespace nbs {
namespace {

/// Position in `ring` of the best ear, -1 if there is none.
int FindEar(std::span<const LoopCorner> corners, const std::vector<uint32_t>& ring,
            const std::function<bool(uint32_t, uint32_t)>& may_join) {
  int best = -1;
  float best_length = std::numeric_limits<float>::max();
  const size_t n = ring.size();
  for (size_t i = 0; i < n; ++i) {
    const uint32_t a = ring[(i + n - 1) % n], b = ring[i], c = ring[(i + 1) % n];
    const float length = (corners[c].p_W - corners[a].p_W).squaredNorm();
    if (length >= best_length || !FacesItsNormals(corners[a], corners[b], corners[c]) || !may_join(a, c)) continue;
    best = static_cast<int>(i);
    best_length = length;
  }
  return best;
}

}  // namespace

bool FacesItsNormals(const LoopCorner& a, const LoopCorner& b, const LoopCorner& c) {
  const Eigen::Vector3f u = b.p_W - a.p_W, v = c.p_W - a.p_W;
  const Eigen::Vector3f n = u.cross(v);
  constexpr float kLeastSine = 0.02f;  // Of the angle at a corner: flatter is no triangle.
  const float size = n.norm();
  if (size < kLeastSine * std::max({u.squaredNorm(), v.squaredNorm(), (v - u).squaredNorm()}) * 0.5f) return false;
  constexpr float kLeastCosine = 0.1f;
  return n.dot(a.normal_W) > kLeastCosine * size && n.dot(b.normal_W) > kLeastCosine * size &&
         n.dot(c.normal_W) > kLeastCosine * size;
}

std::vector<std::array<uint32_t, 3>> TriangulateLoop(std::span<const LoopCorner> corners,
                                                     const std::function<bool(uint32_t, uint32_t)>& may_join) {
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> ring(corners.size());
  for (uint32_t i = 0; i < ring.size(); ++i) ring[i] = i;
  while (ring.size() > 3) {
    const int ear = FindEar(corners, ring, may_join);
    if (ear < 0) return {};
    const size_t n = ring.size();
    triangles.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]});
    ring.erase(ring.begin() + ear);
  }
  if (ring.size() < 3 || !FacesItsNormals(corners[ring[0]], corners[ring[1]], corners[ring[2]])) return {};
  triangles.push_back({ring[0], ring[1], ring[2]});
  return triangles;
}

}  // namespace nbs
