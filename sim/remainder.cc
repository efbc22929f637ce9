#include "sim/remainder.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/borders.h"
#include "common/geometry/directions.h"
#include "sim/point_grid.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// Turns about the line of sight that are tried for a body that is not round about it.
constexpr int kRolls = 8;

bool IsRoundAboutSight(const std::vector<Sphere>& body_S) {
  return std::all_of(body_S.begin(), body_S.end(), [](const Sphere& s) { return s.center.head<2>().norm() < 1e-9; });
}

}  // namespace

std::string_view ToString(Missing kind) {
  constexpr std::array<std::string_view, kMissingKinds> kNames = {"open", "no_room", "base", "depth_of_field",
                                                                  "occluded"};
  return kNames.at(static_cast<size_t>(kind));
}

RemainderExplainer::RemainderExplainer(const TriangleMesh& truth_W, const CoverageOracle& oracle,
                                       const RemainderSettings& settings)
    : settings_(settings), oracle_(&oracle), truth_W_(truth_W), directions_W_(MakeSphereDirections(kSightDirections)) {}

bool RemainderExplainer::IsFree(const SurfaceSample& sample, const Vector3d& direction_W, double length_m) const {
  const TriangleScene::Segment sight{sample.p_W, sample.p_W + length_m * direction_W};
  return truth_W_.FindBlocked({&sight, 1}, kSurfaceSkip_m)[0] == 0;
}

bool RemainderExplainer::IsAboveTable(const Vector3d& p_W) const {
  return !settings_.table_z_m || p_W.z() >= *settings_.table_z_m;
}

bool RemainderExplainer::BodyFits(const Vector3d& p_WS, const Vector3d& direction_W) const {
  const int rolls = IsRoundAboutSight(settings_.body_S) ? 1 : kRolls;
  const Vector3d across_W = direction_W.unitOrthogonal();
  for (int roll = 0; roll < rolls; ++roll) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * roll / rolls, direction_W);
    const Pose X_WS = MakeLookPose(p_WS, -direction_W, turn * across_W);
    const bool fits = std::all_of(settings_.body_S.begin(), settings_.body_S.end(), [&](const Sphere& sphere) {
      const double needed = sphere.radius_m + settings_.body_margin_m;
      const Vector3d center_W = X_WS * sphere.center;
      return IsAboveTable(center_W - needed * Vector3d::UnitZ()) && !truth_W_.FindClosest(center_W, needed);
    });
    if (fits) return true;
  }
  return false;
}

bool RemainderExplainer::HasRoom(const SurfaceSample& sample, const Vector3d& direction_W) const {
  const Profiler& profiler = settings_.profiler;
  for (double depth = profiler.min_depth_m; depth <= profiler.max_depth_m; depth += settings_.standoff_step_m) {
    if (!IsFree(sample, direction_W, depth)) return false;
    if (BodyFits(sample.p_W + depth * direction_W, direction_W)) return true;
  }
  return false;
}

Missing RemainderExplainer::Classify(const SurfaceSample& sample) const {
  const Profiler& profiler = settings_.profiler;
  const double min_cosine = std::cos(profiler.max_incidence_rad);
  Missing found = Missing::kOccluded;
  const auto improve = [&found](Missing kind) { found = std::min(found, kind); };
  for (int d = -1; d < kSightDirections && found != Missing::kOpen; ++d) {
    const Vector3d direction_W = d < 0 ? sample.normal_W : directions_W_[d];
    if (direction_W.dot(sample.normal_W) < min_cosine) continue;
    if (!IsFree(sample, direction_W, settings_.narrow_m)) continue;
    improve(Missing::kDepthOfField);
    if (!IsFree(sample, direction_W, profiler.min_depth_m)) continue;
    improve(Missing::kBase);
    if (!IsAboveTable(sample.p_W + profiler.min_depth_m * direction_W)) continue;
    improve(Missing::kNoRoom);
    if (HasRoom(sample, direction_W)) improve(Missing::kOpen);
  }
  return found;
}

Remainder RemainderExplainer::Explain(const TriangleMesh& mesh_W) const {
  const std::vector<SurfaceSample>& samples = oracle_->samples();
  const std::vector<uint8_t> covered = oracle_->FindCovered(mesh_W);
  std::vector<Missing> kinds(samples.size(), Missing::kOpen);
  PointGrid missing(settings_.rim_reach_m);
  Remainder remainder;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (covered[i] != 0) continue;
    kinds[i] = Classify(samples[i]);
    remainder.missing[static_cast<size_t>(kinds[i])] += 1.0;
    missing.Insert(samples[i].p_W, static_cast<uint32_t>(i));
  }
  for (double& share : remainder.missing) share /= static_cast<double>(samples.size());
  for (const BorderEdge& edge : FindBorderEdges(mesh_W.triangles)) {
    const Vector3d from_W = mesh_W.vertices_W[edge.from].cast<double>(),
                   to_W = mesh_W.vertices_W[edge.to].cast<double>();
    const Vector3d middle_W = 0.5 * (from_W + to_W);
    const auto near = missing.FindNear(middle_W);
    const auto nearest = std::min_element(near.begin(), near.end(), [&](uint32_t a, uint32_t b) {
      return (samples[a].p_W - middle_W).squaredNorm() < (samples[b].p_W - middle_W).squaredNorm();
    });
    double& length = nearest == near.end() ? remainder.seam_m : remainder.rim_m[static_cast<size_t>(kinds[*nearest])];
    length += (to_W - from_W).norm();
  }
  return remainder;
}

}  // namespace nbs
