#include "services/mesher/roof.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace nbs {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

float CalcKernel(float squared_distance, float squared_radius) {
  const float s = 1.0f - squared_distance / squared_radius;
  return s > 0.0f ? s * s : 0.0f;
}

constexpr size_t kMostPlanes = 3;

/// True if no normal turns from their mean by the angle or more: then no two of them, nor means of them, by twice that.
bool AreWithinCone(std::span<const Tangent> tangents, float angle_rad) {
  Vector3f sum = Vector3f::Zero();
  for (const Tangent& t : tangents) sum += t.normal_W;
  const float least = std::cos(angle_rad) * sum.norm();
  return std::all_of(tangents.begin(), tangents.end(), [&](const Tangent& t) { return t.normal_W.dot(sum) > least; });
}

}  // namespace

Roof::Plane Roof::MakePlane(std::span<const Tangent> group, const Vector3f& p_W, float reach_m) {
  Plane plane{Vector3f::Zero(), Vector3f::Zero()};
  float weight = 0.0f;
  for (const Tangent& t : group) {
    const float w = CalcKernel((t.p_W - p_W).squaredNorm(), reach_m * reach_m);
    plane.normal_W += w * t.normal_W;
    plane.p_W += w * (t.p_W - p_W);
    weight += w;
  }
  plane.normal_W.normalize();
  plane.p_W = p_W + plane.p_W / weight;
  return plane;
}

std::optional<Roof> Roof::Fit(std::span<const Tangent> tangents, const Vector3f& p_W, const RoofSettings& settings) {
  std::vector<Tangent> sorted;
  for (const Tangent& t : tangents) {
    if ((t.p_W - p_W).squaredNorm() < settings.reach_m * settings.reach_m) sorted.push_back(t);
  }
  if (AreWithinCone(sorted, 0.5f * settings.least_angle_rad)) return std::nullopt;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Tangent& a, const Tangent& b) {
    return (a.p_W - p_W).squaredNorm() < (b.p_W - p_W).squaredNorm();
  });
  Roof roof;
  std::array<std::span<const Tangent>, kMostPlanes> groups;
  const float least_cosine = std::cos(settings.same_angle_rad);
  for (auto left = sorted.begin(); left != sorted.end() && roof.planes_.size() < kMostPlanes;) {
    const Tangent seed = *left;
    const auto end = std::stable_partition(left, sorted.end(), [&](const Tangent& t) {
      return t.normal_W.dot(seed.normal_W) >= least_cosine &&
             std::abs(seed.normal_W.dot(t.p_W - seed.p_W)) <= settings.same_height_m;
    });
    const std::span<const Tangent> group(left, end);
    left = end;
    if (group.size() < settings.least_tangents) continue;
    groups[roof.planes_.size()] = group;
    roof.planes_.push_back(MakePlane(group, p_W, settings.reach_m));
  }
  if (roof.planes_.size() < 2) return std::nullopt;
  for (size_t i = 0; i < roof.planes_.size(); ++i) {
    if (!roof.LiesBelowOthers(i, groups[i], settings)) return std::nullopt;
  }
  return roof;
}

bool Roof::LiesBelowOthers(size_t plane, std::span<const Tangent> group, const RoofSettings& settings) const {
  for (size_t i = 0; i < planes_.size(); ++i) {
    if (i == plane) continue;
    if (planes_[i].normal_W.dot(planes_[plane].normal_W) > std::cos(settings.least_angle_rad)) return false;
    for (const Tangent& t : group) {
      if (planes_[i].CalcHeight(t.p_W) > settings.most_overlap_m) return false;
    }
  }
  return true;
}

size_t Roof::FindTop(const Vector3f& p_W) const {
  size_t top = 0;
  for (size_t i = 1; i < planes_.size(); ++i) {
    if (planes_[i].CalcHeight(p_W) > planes_[top].CalcHeight(p_W)) top = i;
  }
  return top;
}

float Roof::CalcHeight(const Vector3f& p_W) const { return planes_[FindTop(p_W)].CalcHeight(p_W); }

bool Roof::IsOn(const Vector3f& p_W) const {
  constexpr float kTolerance_m = 0.0001f;
  return CalcHeight(p_W) < kTolerance_m;
}

Tangent Roof::Project(const Vector3f& p_W) const {
  const Plane& top = planes_[FindTop(p_W)];
  return {p_W - top.CalcHeight(p_W) * top.normal_W, top.normal_W};
}

std::optional<Roof::Feature> Roof::FindCorner() const {
  if (planes_.size() < 3) return std::nullopt;
  Matrix3f A;
  Vector3f b, sum = Vector3f::Zero();
  const Vector3f& origin_W = planes_[0].p_W;
  for (int i = 0; i < 3; ++i) {
    A.row(i) = planes_[i].normal_W.transpose();
    b[i] = planes_[i].normal_W.dot(planes_[i].p_W - origin_W);
    sum += planes_[i].normal_W;
  }
  constexpr float kLeastVolume = 0.15f;
  if (!(std::abs(A.determinant()) > kLeastVolume) || !(sum.norm() > kLeastVolume)) return std::nullopt;
  return Feature{{origin_W + A.inverse() * b, sum.normalized()}, Vector3f::Zero()};
}

std::vector<Roof::Feature> Roof::FindFeet(const Vector3f& p_W) const {
  std::vector<Feature> feet;
  for (size_t i = 0; i < planes_.size(); ++i) {
    for (size_t j = i + 1; j < planes_.size(); ++j) {
      const Vector3f &m = planes_[i].normal_W, &n = planes_[j].normal_W;
      const float cosine = m.dot(n), determinant = 1.0f - cosine * cosine;
      constexpr float kLeastDeterminant = 0.15f;
      if (determinant < kLeastDeterminant) continue;
      const float a = planes_[i].CalcHeight(p_W), b = planes_[j].CalcHeight(p_W);
      const Vector3f foot_W = p_W - ((a - cosine * b) * m + (b - cosine * a) * n) / determinant;
      if (IsOn(foot_W)) feet.push_back({{foot_W, (m + n).normalized()}, m.cross(n).normalized()});
    }
  }
  return feet;
}

}  // namespace nbs
