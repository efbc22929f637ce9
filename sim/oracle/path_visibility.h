#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"
#include "sim/scene.h"
#include "sim/surface_samples.h"

namespace nbs {

/// Which samples of a surface a profiler sees while it moves along straight scan paths.
///
/// A sample is seen by the one stripe in whose light plane it lies, which on a straight path of one orientation has a
/// closed form, if there: the position is on the path; the sample lies in the depth of field and in the fan; the beam
/// meets the outer side at no more than the largest incidence; and nothing is between emitter and sample, nor, with a
/// camera, between camera and sample. As SimulatedProfiler, with beams and stripes infinitely dense and no noise.
class PathVisibility {
 public:
  /// @param object_W, samples  Must outlive this.
  PathVisibility(const TriangleScene& object_W, std::span<const SurfaceSample> samples, const Profiler& profiler);

  /// Numbers of the samples seen, rising. A path along its own stripe sees nothing. May be called from several threads.
  ///
  /// @throws std::invalid_argument if the orientation turns along the path by more than 1e-6 rad.
  std::vector<uint32_t> FindSeen(const ScanPath& path) const;

 private:
  const TriangleScene* object_W_;
  std::span<const SurfaceSample> samples_;
  Profiler profiler_;
  double min_cosine_;
  double tan_half_fan_;
};

}  // namespace nbs
