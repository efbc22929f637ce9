#include "services/planner/motion_planning/flange_path.h"

#include <cmath>

namespace nbs {
namespace {

constexpr double kLargestRise = 1e-4;  // metres

}  // namespace

std::vector<Pose> MakeFlangePath(const Pose& X_FS, const ScanPath& path) {
  const Pose X_SF = X_FS.inverse();
  const double turn_rad = CalcAngleBetween(path.X_WS_start, path.X_WS_end);
  // Rise of an arc of radius r over the angle a: r a^2 / 8.
  const double pieces = std::ceil(turn_rad * std::sqrt(X_SF.translation().norm() / (8.0 * kLargestRise)));
  const int n = std::max(1, static_cast<int>(pieces));
  std::vector<Pose> poses_WF;
  poses_WF.reserve(n + 1);
  poses_WF.push_back(path.X_WS_start * X_SF);
  for (int k = 1; k < n; ++k) {
    poses_WF.push_back(Interpolate(path.X_WS_start, path.X_WS_end, static_cast<double>(k) / n) * X_SF);
  }
  poses_WF.push_back(path.X_WS_end * X_SF);
  return poses_WF;
}

ScanPath CutPath(const ScanPath& path, double begin, double end) {
  const auto at = [&](double fraction) {
    if (fraction == 0.0) return path.X_WS_start;
    if (fraction == 1.0) return path.X_WS_end;
    return Interpolate(path.X_WS_start, path.X_WS_end, fraction);
  };
  return {at(begin), at(end)};
}

ScanPath ReversePath(const ScanPath& path) { return {path.X_WS_end, path.X_WS_start}; }

}  // namespace nbs
