#include "sim/closest_on_triangle.h"

#include <Eigen/Dense>
#include <algorithm>

namespace nbs {
namespace {

Eigen::Vector3d CalcClosestOnSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  if (squared == 0.0) return a;
  return a + std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) * ab;
}

Eigen::Vector3d CalcClosestOnEdges(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c) {
  Eigen::Vector3d best = CalcClosestOnSegment(p, a, b);
  for (const Eigen::Vector3d& q : {CalcClosestOnSegment(p, b, c), CalcClosestOnSegment(p, c, a)}) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

}  // namespace

Eigen::Vector3d CalcClosestOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                      const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double va = d3 * d6 - d5 * d4;
  const double vb = d5 * d2 - d1 * d6;
  const double vc = d1 * d4 - d3 * d2;
  const double sum = va + vb + vc;
  if (va <= 0.0 || vb <= 0.0 || vc <= 0.0 || !(sum > 0.0)) return CalcClosestOnEdges(p, a, b, c);
  return a + ab * (vb / sum) + ac * (vc / sum);
}

}  // namespace nbs
