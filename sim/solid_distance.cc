#include "sim/solid_distance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <limits>

#include "common/kinematics/shape_distance.h"
#include "sim/closest_on_triangle.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// Whether the straight line from p to q goes through the triangle (Moeller & Trumbore 1997, for a segment).
bool Pierces(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d along = q - p;
  const Vector3d normal = (b - a).cross(c - a);
  const double slope = along.dot(normal);
  if (slope == 0.0) return false;
  const double share = (a - p).dot(normal) / slope;
  if (share < 0.0 || share > 1.0) return false;
  const Vector3d x = p + share * along;
  return (b - a).cross(x - a).dot(normal) >= 0.0 && (c - b).cross(x - b).dot(normal) >= 0.0 &&
         (a - c).cross(x - c).dot(normal) >= 0.0;
}

std::array<Vector3d, 8> MakeCorners(const Block& block) {
  std::array<Vector3d, 8> corners;
  for (int k = 0; k < 8; ++k) {
    const Vector3d sign((k & 1) != 0 ? 1.0 : -1.0, (k & 2) != 0 ? 1.0 : -1.0, (k & 4) != 0 ? 1.0 : -1.0);
    corners[static_cast<size_t>(k)] = block.X_LC * sign.cwiseProduct(block.half);
  }
  return corners;
}

/// Pairs of MakeCorners that an edge joins: they differ in one bit.
std::array<std::pair<size_t, size_t>, 12> MakeEdges() {
  std::array<std::pair<size_t, size_t>, 12> edges;
  size_t count = 0;
  for (size_t k = 0; k < 8; ++k) {
    for (size_t bit = 1; bit < 8; bit *= 2) {
      if ((k & bit) == 0) edges[count++] = {k, k | bit};
    }
  }
  return edges;
}

/// Smallest distance of the edges of one box from the other.
double CalcEdgeDistance(const Block& of, const Block& from) {
  const Pose X_CW = from.X_LC.inverse();
  const auto corners = MakeCorners(of);
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [i, k] : MakeEdges())
    smallest = std::min(smallest, CalcSegmentBoxDistance(X_CW * corners[i], X_CW * corners[k], from.half));
  return smallest;
}

}  // namespace

double CalcTriangleDistance(const Capsule& capsule_W, const Vector3d& a_W, const Vector3d& b_W, const Vector3d& c_W) {
  const Vector3d& p = capsule_W.p_A;
  const Vector3d& q = capsule_W.p_B;
  double distance = (CalcClosestOnTriangle(p, a_W, b_W, c_W) - p).norm();
  if (p != q) {
    if (Pierces(p, q, a_W, b_W, c_W)) return -capsule_W.radius_m;
    distance =
        std::min({distance, (CalcClosestOnTriangle(q, a_W, b_W, c_W) - q).norm(), CalcSegmentDistance(p, q, a_W, b_W),
                  CalcSegmentDistance(p, q, b_W, c_W), CalcSegmentDistance(p, q, c_W, a_W)});
  }
  return distance - capsule_W.radius_m;
}

double CalcTriangleDistance(const Block& block_W, const Vector3d& a_W, const Vector3d& b_W, const Vector3d& c_W) {
  const Pose X_CW = block_W.X_LC.inverse();
  const std::array<Vector3d, 3> t = {X_CW * a_W, X_CW * b_W, X_CW * c_W};
  double distance =
      std::min({CalcSegmentBoxDistance(t[0], t[1], block_W.half), CalcSegmentBoxDistance(t[1], t[2], block_W.half),
                CalcSegmentBoxDistance(t[2], t[0], block_W.half)});
  if (distance <= 0.0) return 0.0;
  const auto corners = MakeCorners({Pose::Identity(), block_W.half});
  for (const auto& [i, k] : MakeEdges()) {
    if (Pierces(corners[i], corners[k], t[0], t[1], t[2])) return 0.0;
  }
  for (const Vector3d& corner : corners)
    distance = std::min(distance, (CalcClosestOnTriangle(corner, t[0], t[1], t[2]) - corner).norm());
  return distance;
}

std::optional<double> FindDistance(const Capsule& capsule_W, const TriangleScene& scene_W, double enough_m) {
  const Vector3d middle = 0.5 * (capsule_W.p_A + capsule_W.p_B);
  const double reach_m = 0.5 * (capsule_W.p_B - capsule_W.p_A).norm() + capsule_W.radius_m;
  return scene_W.FindDistance(middle, reach_m, enough_m, [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return CalcTriangleDistance(capsule_W, a, b, c);
  });
}

std::optional<double> FindDistance(const Block& block_W, const TriangleScene& scene_W, double enough_m) {
  return scene_W.FindDistance(
      block_W.X_LC.translation(), block_W.half.norm(), enough_m,
      [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) { return CalcTriangleDistance(block_W, a, b, c); });
}

double CalcBlockDistance(const Capsule& capsule_W, const Block& block_W) {
  const Pose X_CW = block_W.X_LC.inverse();
  return CalcSegmentBoxDistance(X_CW * capsule_W.p_A, X_CW * capsule_W.p_B, block_W.half) - capsule_W.radius_m;
}

double CalcBlockDistance(const Block& block_W, const Block& other_W) {
  // Two convex bodies that meet: an edge of one meets the other, or one holds the other, and then all of its edges.
  return std::min(CalcEdgeDistance(block_W, other_W), CalcEdgeDistance(other_W, block_W));
}

double CalcLowest(const Capsule& capsule_W) {
  return std::min(capsule_W.p_A.z(), capsule_W.p_B.z()) - capsule_W.radius_m;
}

double CalcLowest(const Block& block_W) {
  return block_W.X_LC.translation().z() - block_W.X_LC.linear().row(2).cwiseAbs().dot(block_W.half.transpose());
}

}  // namespace nbs
