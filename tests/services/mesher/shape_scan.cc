#include "tests/services/mesher/shape_scan.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/directions.h"
#include "sim/mesh_measures.h"
#include "sim/simulated_profiler.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// Half the extent of the mesh about a point along a unit direction.
double CalcReach(const TriangleMesh& mesh_W, const Vector3d& p_W, const Vector3d& direction_W) {
  double reach = 0.0;
  for (const Eigen::Vector3f& v : mesh_W.vertices_W)
    reach = std::max(reach, std::abs((v.cast<double>() - p_W).dot(direction_W)));
  return reach;
}

/// Across the view, as near to the direction in which the mesh is longest as that allows.
Vector3d FindScanDirection(const Eigen::AlignedBox3d& box, const Vector3d& view_W) {
  int longest = 2;
  for (int i = 0; i < 2; ++i) {
    if (box.sizes()[i] > 1.01 * box.sizes()[longest]) longest = i;
  }
  const Vector3d axis = Vector3d::Unit(longest), across = axis - axis.dot(view_W) * view_W;
  return across.norm() > 0.1 ? across.normalized() : view_W.unitOrthogonal();
}

}  // namespace

std::vector<Sweep> MakeSweepsFromDirections(const TriangleMesh& mesh_W, const Profiler& profiler, int count) {
  constexpr double kNearest_m = 0.2, kOverrun_m = 0.01, kOverlap = 0.8;
  const Eigen::AlignedBox3d box = CalcBoundingBox(mesh_W);
  std::vector<Sweep> sweeps;
  for (const Vector3d& direction : MakeSphereDirections(count)) {
    const Vector3d view = -direction, along = FindScanDirection(box, view), side = view.cross(along);
    const double depth = CalcReach(mesh_W, box.center(), view), width = CalcReach(mesh_W, box.center(), side);
    const double distance = std::max(profiler.standoff_m, depth + kNearest_m);
    const double lane = 2.0 * kOverlap * std::tan(0.5 * profiler.fan_rad) * (distance - depth);
    const int lanes = std::max(1, static_cast<int>(std::ceil(2.0 * width / lane)));
    const Vector3d half = (CalcReach(mesh_W, box.center(), along) + kOverrun_m) * along;
    for (int i = 0; i < lanes; ++i) {
      const Vector3d middle = box.center() - distance * view + ((2.0 * i + 1.0) / lanes - 1.0) * width * side;
      sweeps.push_back(
          {static_cast<int32_t>(sweeps.size()), middle - half, middle + half, view, Vector3d::Zero(), 0.002});
    }
  }
  return sweeps;
}

std::vector<Stripe> ScanMesh(const TriangleScene& scene_W, const Profiler& profiler, const Sweep& sweep) {
  const SimulatedProfiler simulated(scene_W, profiler, 1);
  return MakeStripes(sweep,
                     [&](const Pose& X_WS, int32_t index) { return simulated.TakeProfile(X_WS, sweep.scan, index); });
}

std::vector<Stripe> ScanMesh(const TriangleScene& scene_W, const Profiler& profiler, const std::vector<Sweep>& sweeps) {
  std::vector<Stripe> all;
  for (const Sweep& sweep : sweeps) {
    for (Stripe& stripe : ScanMesh(scene_W, profiler, sweep)) all.push_back(std::move(stripe));
  }
  return all;
}

Profiler MakeNoisier(Profiler profiler, double factor) {
  profiler.sigma_base_m *= factor;
  profiler.sigma_per_m *= factor;
  return profiler;
}

void DisplaceSweeps(double offset_m, uint64_t seed, std::vector<Sweep>& sweeps) {
  for (size_t i = 0; i < sweeps.size(); ++i) {
    const Vector3d direction(CalcGaussian({seed, i, 0}), CalcGaussian({seed, i, 1}), CalcGaussian({seed, i, 2}));
    sweeps[i].offset_W = offset_m * direction.normalized();
  }
}

void AddOutliers(const Profiler& profiler, double share, uint64_t seed, std::vector<Stripe>& stripes) {
  for (size_t s = 0; s < stripes.size(); ++s) {
    for (size_t i = 0; i < stripes[s].ranges_m.size(); ++i) {
      float& range = stripes[s].ranges_m[i];
      if (range == 0.0f || CalcUniform({seed, s, i, 0}) >= share) continue;
      const double depth_share = CalcBeamDirection_S(profiler, static_cast<int>(i)).z();
      range = static_cast<float>(std::clamp(range * (0.6 + 0.7 * CalcUniform({seed, s, i, 1})),
                                            profiler.min_depth_m / depth_share, profiler.max_depth_m / depth_share));
    }
  }
}

ScannedPoints CollectPoints(const Profiler& profiler, const std::vector<Stripe>& stripes) {
  const std::vector<Vector3d> directions_S = CalcBeamDirections_S(profiler);
  ScannedPoints points;
  for (const Stripe& stripe : stripes) {
    for (size_t i = 0; i < stripe.ranges_m.size(); ++i) {
      if (stripe.ranges_m[i] == 0.0f) continue;
      const Vector3d beam_W = stripe.X_WS.linear() * directions_S[i];
      points.p_W.push_back((stripe.X_WS.translation() + stripe.ranges_m[i] * beam_W).cast<float>());
      points.view_W.push_back(-beam_W.cast<float>());
    }
  }
  return points;
}

}  // namespace nbs
