#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/triangle_mesh.h"
#include "common/sensing/profiler.h"
#include "sim/scene.h"
#include "tests/services/mesher/synthetic_scan.h"

namespace nbs {

/// Straight sweeps that look at the mesh from `count` directions spread evenly over the sphere, as many beside each
/// other as its width takes; each is a scan of its own. The middle of the mesh lies at the stand-off, or further off
/// where the mesh would come nearer than 200 mm.
std::vector<Sweep> MakeSweepsFromDirections(const TriangleMesh& mesh_W, const Profiler& profiler, int count);

/// The stripes of a sweep over a mesh, the closing one included. The noise is a function of (scan, stripe, beam).
std::vector<Stripe> ScanMesh(const TriangleScene& scene_W, const Profiler& profiler, const Sweep& sweep);

/// All sweeps, scan after scan.
std::vector<Stripe> ScanMesh(const TriangleScene& scene_W, const Profiler& profiler, const std::vector<Sweep>& sweeps);

/// The profiler with its noise times `factor`.
Profiler MakeNoisier(Profiler profiler, double factor);

/// Shifts each sweep by `offset_m` in a random direction of its own: the error of its reported poses.
void DisplaceSweeps(double offset_m, uint64_t seed, std::vector<Sweep>& sweeps);

/// Replaces a share of the ranges that returned by ranges evenly spread between 60 and 130 % of what they were, in the
/// depth of field.
void AddOutliers(const Profiler& profiler, double share, uint64_t seed, std::vector<Stripe>& stripes);

/// The points of all stripes, and the directions from them towards the sensor.
struct ScannedPoints {
  std::vector<Eigen::Vector3f> p_W;
  std::vector<Eigen::Vector3f> view_W;
};
ScannedPoints CollectPoints(const Profiler& profiler, const std::vector<Stripe>& stripes);

}  // namespace nbs
