#include "sim/objects/sdf_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace nbs {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The bounds of ellipsoids and cloths may grow faster than the distance, by no more than this.
constexpr double kSteepest = 1.25;

/// Minimum of a and b with the corner rounded over the width k; exactly the minimum where they differ by k or more.
double CalcSmoothMin(double a, double b, double k) {
  if (k <= 0.0) return std::min(a, b);
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * k * h * h;
}

}  // namespace

double Ellipsoid::Distance(const Vector3d& p_P) const {
  const Vector3d q = p_P.cwiseQuotient(half_axes);
  const double k0 = q.norm();
  const double k1 = q.cwiseQuotient(half_axes).norm();
  return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -half_axes.minCoeff();
}

double RoundCone::Distance(const Vector3d& p_P) const {
  const double slope = (radius_a - radius_b) / length;
  const double a = std::sqrt(1.0 - slope * slope);
  const Vector2d q(std::hypot(p_P.x(), p_P.y()), p_P.z());
  const double k = -slope * q.x() + a * q.y();
  if (k < 0.0) return q.norm() - radius_a;
  if (k > a * length) return (q - Vector2d(0.0, length)).norm() - radius_b;
  return a * q.x() + slope * q.y() - radius_a;
}

double Torus::Distance(const Vector3d& p_P) const {
  return std::hypot(std::hypot(p_P.x(), p_P.y()) - ring_radius, p_P.z()) - tube_radius;
}

double Cylinder::Distance(const Vector3d& p_P) const {
  double r = std::hypot(p_P.x(), p_P.y());
  if (flutes > 0) r += flute_depth * std::pow(std::abs(std::cos(0.5 * flutes * std::atan2(p_P.y(), p_P.x()))), 3.0);
  const Vector2d d(r - radius + rounding, std::abs(p_P.z()) - half_height + rounding);
  return std::min(d.maxCoeff(), 0.0) + d.cwiseMax(0.0).norm() - rounding;
}

double Bowl::Distance(const Vector3d& p_P) const {
  const double rim_radius = std::sqrt(radius * radius - rim_height * rim_height);
  const Vector2d q(std::hypot(p_P.x(), p_P.y()), p_P.z());
  const bool beyond_rim = rim_height * q.x() < rim_radius * q.y();
  const double to_wall = beyond_rim ? (q - Vector2d(rim_radius, rim_height)).norm() : std::abs(q.norm() - radius);
  return to_wall - 0.5 * thickness;
}

double Cloth::CalcOffset(double across, double down) const {
  // The folds run out towards the edges of the sheet.
  const double depth = fold_depth * (0.2 + 0.8 * down) * (1.0 - 0.7 * std::pow(std::min(std::abs(across), 1.0), 4.0));
  const double phase =
      std::numbers::pi * folds * across + 1.3 * std::sin(2.6 * down + 2.0 * across) + 0.8 * across * down;
  const double folded = std::sin(phase) + 0.4 * std::sin(1.63 * phase + 2.1 * down + 1.0);
  return depth * folded + bend * across * across + sway * std::sin(std::numbers::pi * down);
}

double Cloth::Distance(const Vector3d& p_P) const {
  const double down = std::clamp(0.5 - 0.5 * p_P.z() / half_height, 0.0, 1.0);
  const double width = half_width * (gather + (1.0 - gather) * down);
  const double across = std::clamp(p_P.x() / width, -1.2, 1.2);
  const double offset = CalcOffset(across, down);
  const double slope = (CalcOffset(across + 0.01, down) - offset) / (0.01 * width);
  const double foot = half_height * (1.0 - 0.05 * (1.0 + std::sin(3.7 * across + 1.0)) * down);
  const Vector3d d(std::abs(p_P.x()) - width,
                   std::abs(p_P.y() - offset) / std::sqrt(1.0 + slope * slope) - 0.5 * thickness,
                   std::abs(p_P.z()) - foot);
  const double rounding = 0.45 * thickness;
  const Vector3d inner = d.array() + rounding;
  return 0.85 * (std::min(inner.maxCoeff(), 0.0) + inner.cwiseMax(0.0).norm() - rounding);
}

double SdfShape::Step::Distance(const Vector3d& p_O) const {
  const Vector3d p_P = X_PO * p_O;
  double distance = std::visit([&p_P](const auto& s) { return s.Distance(p_P); }, solid);
  if (seam.ripple > 0.0 && std::abs(distance) < 8.0 * seam.ripple) {
    const Vector3d q = p_O / seam.ripple_size;
    distance += seam.ripple * std::sin(3.1 * q.x() + 1.3 * std::sin(2.3 * q.z())) *
                std::sin(2.9 * q.y() + 1.1 * std::sin(1.9 * q.x())) *
                std::sin(3.3 * q.z() + 1.2 * std::sin(2.1 * q.y()));
  }
  return distance;
}

double SdfShape::Step::Join(double running, double distance) const {
  return cut ? -CalcSmoothMin(-running, distance, seam.blend) : CalcSmoothMin(running, distance, seam.blend);
}

std::vector<uint16_t> SdfShape::AllSteps() const {
  std::vector<uint16_t> all(steps_.size());
  std::iota(all.begin(), all.end(), uint16_t{0});
  return all;
}

std::vector<uint16_t> SdfShape::FindSteps(const Vector3d& p_O, double radius, std::span<const uint16_t> steps) const {
  // Where the surface is, the last seam to touch it rounds by a quarter of its width: a solid farther off than 5/4 of
  // every later seam is no part of it.
  std::vector<double> widest(steps.size() + 1, 0.0);
  for (size_t n = steps.size(); n-- > 0;) widest[n] = std::max(widest[n + 1], steps_[steps[n]].seam.blend);
  std::vector<uint16_t> found;
  double running = std::numeric_limits<double>::max();
  for (size_t n = 0; n < steps.size(); ++n) {
    const Step& step = steps_[steps[n]];
    const double distance = step.Distance(p_O);
    if (distance > 1.25 * widest[n] + step.seam.ripple + kSteepest * radius) continue;
    const double lead = step.cut ? running + distance : distance - running;
    if (lead > step.seam.blend + step.seam.ripple + 2.0 * kSteepest * radius) continue;
    found.push_back(steps[n]);
    running = step.Join(running, distance);
  }
  return found;
}

double SdfShape::Evaluate(const Vector3d& p_O, std::span<const uint16_t> steps) const {
  double running = std::numeric_limits<double>::max();
  for (uint16_t i : steps) {
    const Step& step = steps_[i];
    const double distance = step.Distance(p_O);
    running = step.Join(running, distance);
  }
  return running;
}

SdfShape::Slope SdfShape::CalcSlope(const Vector3d& p_O, std::span<const uint16_t> steps, double step) const {
  Slope slope;
  slope.distance = Evaluate(p_O, steps);
  for (int axis = 0; axis < 3; ++axis) {
    slope.gradient[axis] = (Evaluate(p_O + step * Vector3d::Unit(axis), steps) - slope.distance) / step;
  }
  return slope;
}

}  // namespace nbs
