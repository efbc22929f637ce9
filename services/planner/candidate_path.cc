#include "services/planner/candidate_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nbs {
namespace {

Eigen::Vector3d CalcMiddle(const ScanPath& path) {
  return 0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation());
}

}  // namespace

ScanPath MakeStripPath(const Strip& strip, const Tilt& tilt, double standoff_m, const PathLimits& limits) {
  if (strip.normal_W.norm() < 1e-9) throw std::invalid_argument("MakeStripPath: the normal has no length");
  const Eigen::Vector3d normal_W = strip.normal_W.normalized();
  Eigen::Vector3d along_W = strip.along_W - normal_W * normal_W.dot(strip.along_W);
  if (along_W.norm() < 1e-6 * strip.along_W.norm() || along_W.norm() < 1e-12) {
    throw std::invalid_argument("MakeStripPath: the path is parallel to the normal");
  }
  along_W.normalize();
  const Eigen::Vector3d across_W = along_W.cross(normal_W);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(tilt.about_along_rad, along_W) * Eigen::AngleAxisd(tilt.about_across_rad, across_W))
          .toRotationMatrix();
  const Eigen::Vector3d view_W = -(turn * normal_W);
  const Eigen::Vector3d middle_W = strip.p_W - standoff_m * view_W;
  const double half = 0.5 * std::clamp(strip.extent_m, limits.min_m, limits.max_m);
  return {MakeLookPose(middle_W - half * along_W, view_W, along_W),
          MakeLookPose(middle_W + half * along_W, view_W, along_W)};
}

double CalcHalfWidth(const Profiler& profiler) { return profiler.standoff_m * std::tan(0.5 * profiler.fan_rad); }

double CalcExtent(const Eigen::AlignedBox3d& box_W, const Eigen::Vector3d& direction_W) {
  return box_W.isEmpty() ? 0.0 : box_W.sizes().dot(direction_W.cwiseAbs());
}

Strip ExtendToBox(const Strip& strip, const Eigen::AlignedBox3d& box_W, double overhang_m, const PathLimits& limits) {
  if (box_W.isEmpty()) return strip;
  Strip extended = strip;
  const Eigen::Vector3d along_W =
      (strip.along_W - strip.normal_W * strip.normal_W.dot(strip.along_W) / strip.normal_W.squaredNorm()).normalized();
  const double full = CalcExtent(box_W, along_W) + 2.0 * overhang_m;
  extended.extent_m = std::min(full, limits.max_m);
  // The longer strip still covers the old one, and lies as near to the middle of the object as that allows.
  const double to_middle = along_W.dot(box_W.center() - strip.p_W);
  const double play = std::max(0.0, 0.5 * (extended.extent_m - strip.extent_m));
  extended.p_W += along_W * std::clamp(to_middle, -play, play);
  return extended;
}

bool AreAlike(const ScanPath& a, const ScanPath& b, double distance_m, double angle_rad) {
  const double longer = std::max(a.length_m(), b.length_m());
  if (std::abs(a.length_m() - b.length_m()) > 0.25 * longer) return false;
  if ((CalcMiddle(a) - CalcMiddle(b)).norm() > distance_m) return false;
  const double cosine = std::cos(angle_rad);
  const Eigen::Matrix3d& R_a = a.X_WS_start.linear();
  const Eigen::Matrix3d& R_b = b.X_WS_start.linear();
  return R_a.col(2).dot(R_b.col(2)) >= cosine && std::abs(R_a.col(1).dot(R_b.col(1))) >= cosine;
}

void RemoveAlike(std::vector<Candidate>& candidates, double distance_m, double angle_rad) {
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      return AreAlike(k.path, candidate.path, distance_m, angle_rad);
    });
    if (!known) kept.push_back(std::move(candidate));
  }
  candidates = std::move(kept);
}

}  // namespace nbs
