#include "common/kinematics/shape_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nbs {

using Eigen::Vector3d;

double CalcSegmentDistance(const Vector3d& p_A, const Vector3d& p_B, const Vector3d& p_C, const Vector3d& p_D) {
  constexpr double kPoint = 1e-18;  // square metres
  const Vector3d d1 = p_B - p_A;
  const Vector3d d2 = p_D - p_C;
  const Vector3d r = p_A - p_C;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  double s = 0.0;
  double t = 0.0;
  if (a <= kPoint && e <= kPoint) return r.norm();
  if (a <= kPoint) {
    t = std::clamp(f / e, 0.0, 1.0);
  } else {
    const double c = d1.dot(r);
    if (e <= kPoint) {
      s = std::clamp(-c / a, 0.0, 1.0);
    } else {
      const double b = d1.dot(d2);
      const double denominator = a * e - b * b;
      if (denominator > 0.0) s = std::clamp((b * f - c * e) / denominator, 0.0, 1.0);
      t = (b * s + f) / e;
      if (t < 0.0) {
        t = 0.0;
        s = std::clamp(-c / a, 0.0, 1.0);
      } else if (t > 1.0) {
        t = 1.0;
        s = std::clamp((b - c) / a, 0.0, 1.0);
      }
    }
  }
  return (r + s * d1 - t * d2).norm();
}

double CalcBoxDistance(const Vector3d& p_C, const Vector3d& half) {
  return (p_C.cwiseAbs() - half).cwiseMax(0.0).norm();
}

double CalcSegmentBoxDistance(const Vector3d& p_CA, const Vector3d& p_CB, const Vector3d& half) {
  const Vector3d along = p_CB - p_CA;
  const auto out_at = [&](double share) -> Vector3d {
    const Vector3d p = p_CA + share * along;
    return p - p.cwiseMax(-half).cwiseMin(half);
  };
  // Half of the derivative of the squared distance: it rises, and is straight between the planes of the faces.
  const auto slope_at = [&](double share) { return along.dot(out_at(share)); };
  double low = 0.0;
  double high = 1.0;
  double at_low = slope_at(low);
  if (!(at_low < 0.0)) return out_at(low).norm();
  double at_high = slope_at(high);
  if (!(at_high > 0.0)) return out_at(high).norm();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double face : {-half[axis], half[axis]}) {
      const double share = (face - p_CA[axis]) / along[axis];
      if (!(share > low && share < high)) continue;
      const double slope = slope_at(share);
      (slope < 0.0 ? low : high) = share;
      (slope < 0.0 ? at_low : at_high) = slope;
    }
  }
  const double rise = at_high - at_low;
  return out_at(rise > 0.0 ? low - at_low * (high - low) / rise : low).norm();
}

double CalcBlockBoxDistance(const Block& block, const Vector3d& half) {
  double smallest = std::numeric_limits<double>::infinity();
  // Edges of a box about the origin of a frame, seen from the other's.
  const auto lower = [&](const Vector3d& of, const Pose& X, const Vector3d& other) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (int edge = 0; edge < 4; ++edge) {
        Vector3d p = of;
        if ((edge & 1) != 0) p[u] = -p[u];
        if ((edge & 2) != 0) p[v] = -p[v];
        Vector3d q = p;
        q[axis] = -q[axis];
        smallest = std::min(smallest, CalcSegmentBoxDistance(X * p, X * q, other));
      }
    }
  };
  lower(block.half, block.X_LC, half);
  if (smallest > 0.0) lower(half, block.X_LC.inverse(), block.half);
  return smallest;
}

std::vector<Capsule> CoverBlock(const Block& block) {
  int longest = 0;
  block.half.maxCoeff(&longest);
  const int u = (longest + 1) % 3;
  const int v = (longest + 2) % 3;
  const double thin = std::min(block.half[u], block.half[v]);
  const int rows_u = static_cast<int>(std::ceil(block.half[u] / thin - 1e-9));
  const int rows_v = static_cast<int>(std::ceil(block.half[v] / thin - 1e-9));
  const double step_u = block.half[u] / rows_u;
  const double step_v = block.half[v] / rows_v;
  std::vector<Capsule> capsules;
  for (int i = 0; i < rows_u; ++i) {
    for (int j = 0; j < rows_v; ++j) {
      Vector3d middle = Vector3d::Zero();
      middle[u] = (2 * i + 1 - rows_u) * step_u;
      middle[v] = (2 * j + 1 - rows_v) * step_v;
      const Vector3d reach = block.half[longest] * Vector3d::Unit(longest);
      capsules.push_back({block.X_LC * (middle - reach), block.X_LC * (middle + reach), std::hypot(step_u, step_v)});
    }
  }
  return capsules;
}

std::vector<Capsule> CoverCapsule(const Capsule& capsule, double overshoot_m) {
  const Vector3d along = capsule.p_B - capsule.p_A;
  // Between two middles that lie 2 h apart, spheres of radius R cover a capsule of radius r if R^2 >= r^2 + h^2.
  const double reach = capsule.radius_m + overshoot_m;
  const double h = std::sqrt(reach * reach - capsule.radius_m * capsule.radius_m);
  const int count = static_cast<int>(std::ceil(along.norm() / (2.0 * h) - 1e-9)) + 1;
  if (count <= 1 || along.norm() < 1e-9) return {{capsule.p_A, capsule.p_A, capsule.radius_m}};
  const double half_step = 0.5 * along.norm() / (count - 1);
  const double radius = std::hypot(capsule.radius_m, half_step);
  std::vector<Capsule> spheres;
  for (int k = 0; k < count; ++k) {
    const Vector3d p = capsule.p_A + (static_cast<double>(k) / (count - 1)) * along;
    spheres.push_back({p, p, radius});
  }
  return spheres;
}

}  // namespace nbs
