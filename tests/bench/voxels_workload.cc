#include "tests/bench/voxels_workload.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace nbs::bench {
namespace {

constexpr int kStripes = 200;
constexpr double kSpacing = 0.002;

/// Range to the nearest ball along a unit direction that is met less obliquely than the profiler allows; 0 if there is
/// none.
double CalcRange(const Profiler& profiler, const std::vector<Ball>& figure, const Eigen::Vector3d& p_W,
                 const Eigen::Vector3d& beam_W) {
  double nearest = std::numeric_limits<double>::infinity();
  double cos_incidence = 0.0;
  for (const Ball& ball : figure) {
    const Eigen::Vector3d to_center = ball.p_WB - p_W;
    const double along = to_center.dot(beam_W);
    const double square = ball.radius_m * ball.radius_m - (to_center.squaredNorm() - along * along);
    if (square <= 0.0 || along - std::sqrt(square) <= 0.0 || along - std::sqrt(square) >= nearest) continue;
    nearest = along - std::sqrt(square);
    cos_incidence = std::sqrt(square) / ball.radius_m;
  }
  return std::isfinite(nearest) && cos_incidence >= std::cos(profiler.max_incidence_rad) ? nearest : 0.0;
}

std::vector<Ball> MakeFigure() {
  std::vector<Ball> figure;
  for (int i = 0; i < 9; ++i)
    figure.push_back({{0.02 * std::sin(i), 0.02 * std::cos(i), -0.2 + 0.05 * i}, 0.06 + 0.02 * std::sin(1.7 * i)});
  for (int i = 0; i < 6; ++i) figure.push_back({{0.09 + 0.02 * i, 0.03, 0.12 - 0.03 * i}, 0.03});
  for (int i = 0; i < 6; ++i) figure.push_back({{-0.09 - 0.01 * i, -0.02 * i, 0.1 + 0.02 * i}, 0.03});
  return figure;
}

/// A path that looks at the figure from the azimuth `angle`, along z or across, 0.398 m long.
ScanPath MakePath(double angle, bool upright) {
  const Eigen::Vector3d view_W(std::cos(angle), std::sin(angle), 0.0);
  const Eigen::Vector3d scan_W =
      upright ? Eigen::Vector3d(0.0, 0.0, 1.0) : Eigen::Vector3d(-std::sin(angle), std::cos(angle), 0.0);
  // Off the cells' faces: a stripe that lies in a face belongs to either side by rounding.
  const Eigen::Vector3d middle_W = Eigen::Vector3d(0.0003, 0.0007, 0.0011) - 0.4 * view_W;
  const Eigen::Vector3d half = 0.5 * (kStripes - 1) * kSpacing * scan_W;
  return {MakeLookPose(middle_W - half, view_W, scan_W), MakeLookPose(middle_W + half, view_W, scan_W)};
}

}  // namespace

Stripe CastStripe(const Profiler& profiler, const std::vector<Ball>& figure, const Pose& X_WS) {
  Stripe stripe;
  stripe.X_WS = X_WS;
  for (const Eigen::Vector3d& beam_S : CalcBeamDirections_S(profiler)) {
    const double range = CalcRange(profiler, figure, X_WS.translation(), X_WS.linear() * beam_S);
    const double depth = range * beam_S.z();
    stripe.ranges_m.push_back(depth >= profiler.min_depth_m && depth <= profiler.max_depth_m ? static_cast<float>(range)
                                                                                             : 0.0F);
  }
  return stripe;
}

MappingWorkload MakeMappingWorkload(int scans) {
  MappingWorkload workload;
  workload.figure = MakeFigure();
  for (int scan = 0; scan < scans; ++scan) {
    workload.paths.push_back(MakePath(2.0 * std::numbers::pi * scan * 0.382, scan % 2 == 0));
    std::vector<Stripe>& stripes = workload.scans.emplace_back();
    for (int i = 0; i < kStripes; ++i) {
      const ScanPath& path = workload.paths.back();
      stripes.push_back(CastStripe(workload.profiler, workload.figure,
                                   Interpolate(path.X_WS_start, path.X_WS_end, i / (kStripes - 1.0))));
      stripes.back().scan = scan;
      stripes.back().index = i;
      workload.returns += std::ranges::count_if(stripes.back().ranges_m, [](float range) { return range > 0.0F; });
    }
  }
  return workload;
}

}  // namespace nbs::bench
