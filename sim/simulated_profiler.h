#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose.h"
#include "common/sensing/profiler.h"
#include "sim/scene.h"

namespace nbs {

/// What a laser stripe profiler would measure at a known scene (section IV-A of the paper: each beam is intersected
/// with the object's mesh and noise is applied).
///
/// A beam returns the range to the first surface it meets, if
/// - the point's depth, its z in S, lies in the depth of field; a surface that is nearer blocks the beam all the same;
/// - the beam falls on the outer side of the surface, at no more than the largest incidence from the geometric normal;
/// - the surface is not dark (a table covered in black blocks beams and gives no return);
/// - with a camera (camera_baseline_m other than 0): the camera stands before the surface and nothing is between it and
/// the point. Noise along the beam: Gaussian with CalcRangeSigma(depth), a pure function of (seed, scan, stripe, beam).
class SimulatedProfiler {
 public:
  /// @param scene_W    Must outlive the profiler.
  /// @param dark_from  Triangles from this number on are dark.
  SimulatedProfiler(const TriangleScene& scene_W, const Profiler& profiler, uint64_t seed,
                    uint32_t dark_from = RayHit::kNone);

  /// One stripe: `points` ranges in metres from the emitter; 0: no return.
  ///
  /// @param scan, stripe  Number of the scan and of the stripe within it, >= 0; key of the noise.
  std::vector<float> TakeProfile(const Pose& X_WS, int32_t scan, int32_t stripe) const;

 private:
  std::vector<uint8_t> FindReturns(const Pose& X_WS, const std::vector<Ray>& rays,
                                   const std::vector<RayHit>& hits) const;

  const TriangleScene* scene_W_;
  Profiler profiler_;
  uint64_t seed_;
  uint32_t dark_from_;
  double min_cosine_;
  std::vector<Eigen::Vector3d> directions_S_;
};

}  // namespace nbs
