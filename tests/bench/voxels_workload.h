#pragma once

#include <vector>

#include "common/mapping/voxel_delta.h"
#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"

namespace nbs::bench {

/// A ball of the scene, metres in W.
struct Ball {
  Eigen::Vector3d p_WB;
  double radius_m = 0.0;
};

/// The working map's workload: a figure of balls about 0.5 m high in a box of 200 cubed cells of 5 mm, scanned by
/// straight paths of 200 stripes on a ring around it, with exact ranges.
struct MappingWorkload {
  GridShape shape{Eigen::Vector3d::Constant(-0.5), 0.005, Eigen::Vector3i::Constant(200)};
  Profiler profiler;
  std::vector<Ball> figure;
  std::vector<ScanPath> paths;
  std::vector<std::vector<Stripe>> scans;  ///< One per path.
  int64_t returns = 0;                     ///< Beams with a return, all scans.
};

MappingWorkload MakeMappingWorkload(int scans);

/// A stripe of the figure.
Stripe CastStripe(const Profiler& profiler, const std::vector<Ball>& figure, const Pose& X_WS);

}  // namespace nbs::bench
