#include "services/planner/boundary_search.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

Eigen::Vector3d CalcMean(const BoundarySurface& surface, const std::vector<uint32_t>& vertices) {
  Eigen::Vector3d mean_W = Eigen::Vector3d::Zero();
  for (uint32_t v : vertices) mean_W += surface.Position(v);
  return mean_W / static_cast<double>(vertices.size());
}

/// x out of the surface, y along the chord, z about the normal.
std::optional<Pose> MakePatchFrame(const BoundarySurface& surface, const BoundaryChain& chain) {
  const Eigen::Vector3d chord = surface.Position(chain.vertices.back()) - surface.Position(chain.vertices.front());
  if (chord.norm() < 1e-3) return std::nullopt;
  const Eigen::Vector3d y = chord.normalized();
  const Eigen::Vector3d z_raw = chain.normal_W - y * y.dot(chain.normal_W);
  if (z_raw.norm() < 0.1) return std::nullopt;
  Pose X_WP = Pose::Identity();
  X_WP.linear().col(1) = y;
  X_WP.linear().col(2) = z_raw.normalized();
  X_WP.linear().col(0) = y.cross(X_WP.linear().col(2));
  X_WP.translation() = CalcMean(surface, chain.vertices);
  return X_WP;
}

/// Extent of the chain along the chord, about the patch's origin.
double CalcChainExtent(const BoundarySurface& surface, const BoundaryChain& chain, const QuadraticPatch& patch) {
  double extent = 0.0;
  for (uint32_t v : chain.vertices)
    extent = std::max(extent, std::abs((patch.X_WP.inverse() * surface.Position(v)).y()));
  return 2.0 * extent;
}

/// Distances beyond the border, the middle one first, then outward and inward by turns.
std::vector<double> ListSteps(const Profiler& profiler, const BoundarySearchSettings& settings) {
  const double outermost = std::max(0.0, CalcHalfWidth(profiler) - settings.overlap_m);
  std::vector<double> steps;
  for (int i = 1; i <= settings.steps; ++i) steps.push_back(outermost * i / settings.steps);
  const double middle = 0.5 * outermost * (1.0 + 1.0 / std::max(1, settings.steps));
  std::stable_sort(steps.begin(), steps.end(),
                   [middle](double a, double b) { return std::abs(a - middle) < std::abs(b - middle) - 1e-9; });
  return steps;
}

}  // namespace

std::optional<QuadraticPatch> FitBoundaryPatch(const BoundarySurface& surface, const BoundaryChain& chain,
                                               const BoundarySearchSettings& settings) {
  const std::optional<Pose> X_WP = MakePatchFrame(surface, chain);
  if (!X_WP) return std::nullopt;
  std::vector<Eigen::Vector3d> support_W;
  for (uint32_t v : surface.GrowRegion(chain.vertices, settings.band_m, X_WP->linear().col(2),
                                       std::cos(settings.max_normal_angle_rad))) {
    support_W.push_back(surface.Position(v));
  }
  if (auto patch = FitQuadraticPatch(*X_WP, support_W, settings.patch)) return patch;
  QuadraticPatch plane;
  plane.X_WP = *X_WP;
  return plane;
}

EstimatedSurface Extrapolate(const QuadraticPatch& patch, double distance_m, const BoundarySearchSettings& settings) {
  const Eigen::Vector3d normal_P = patch.CalcNormal_P(0.0, 0.0);
  const double angle = std::atan2(-normal_P.x(), normal_P.z());  // of the tangent along x
  const double curvature =
      std::clamp(patch.CalcCurvatureAlongX(0.0, 0.0), -settings.max_convex_per_m, settings.max_concave_per_m);
  const double end = angle + curvature * distance_m;
  Eigen::Vector3d p_P(0.0, 0.0, patch.CalcHeight(0.0, 0.0));
  if (std::abs(curvature * distance_m) < 1e-6) {
    p_P += distance_m * Eigen::Vector3d(std::cos(angle), 0.0, std::sin(angle));
  } else {
    p_P += Eigen::Vector3d(std::sin(end) - std::sin(angle), 0.0, std::cos(angle) - std::cos(end)) / curvature;
  }
  const Eigen::Vector3d end_normal_P(-std::sin(end), 0.0, std::cos(end));
  return {patch.X_WP * p_P, patch.X_WP.linear() * end_normal_P, -curvature * distance_m};
}

std::vector<ScanPath> MakeChainPaths(const BoundarySurface& surface, const BoundaryChain& chain,
                                     const Profiler& profiler, const BoundarySearchSettings& settings) {
  const std::optional<QuadraticPatch> patch = FitBoundaryPatch(surface, chain, settings);
  if (!patch) return {};
  const Eigen::Vector3d chord_W = patch->X_WP.linear().col(1);
  const double extent = CalcChainExtent(surface, chain, *patch) + 2.0 * settings.overhang_m;
  std::vector<ScanPath> paths;
  for (double tilt : settings.tilts_rad) {
    for (double step : ListSteps(profiler, settings)) {
      const EstimatedSurface beyond = Extrapolate(*patch, step, settings);
      if (std::abs(beyond.turned_rad) > settings.max_turn_away_rad) continue;
      const Strip strip{beyond.p_W, beyond.normal_W, chord_W, extent};
      if (!settings.one_path_per_chain)
        paths.push_back(MakeStripPath(strip, {.about_along_rad = tilt}, profiler.standoff_m, settings.limits));
      if (chain.length_m < settings.min_long_chain_m) continue;
      const Strip extended = ExtendToBox(strip, surface.box_W(), settings.overhang_m, settings.limits);
      paths.push_back(MakeStripPath(extended, {.about_along_rad = tilt}, profiler.standoff_m, settings.limits));
      if (settings.one_path_per_chain) return paths;
    }
  }
  return paths;
}

std::vector<Candidate> FindBoundaryCandidates(const BoundarySurface& surface, int scan, const ScanPath& path,
                                              const Profiler& profiler, const BoundarySearchSettings& settings) {
  std::vector<std::vector<ScanPath>> by_chain;
  size_t most = 0;
  for (const BoundaryChain& chain : FindBoundaryChains(surface, scan, path, settings.chains)) {
    by_chain.push_back(MakeChainPaths(surface, chain, profiler, settings));
    most = std::max(most, by_chain.back().size());
  }
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < most; ++i) {
    for (const auto& paths : by_chain) {
      if (i < paths.size()) candidates.push_back({0, CandidateSource::kBoundary, scan, 0, paths[i]});
    }
  }
  RemoveAlike(candidates, settings.alike_m, settings.alike_rad);
  for (size_t i = 0; i < candidates.size(); ++i) candidates[i].rank = static_cast<int32_t>(i);
  return candidates;
}

}  // namespace nbs
