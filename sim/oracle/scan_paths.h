#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/config/run_config.h"
#include "common/planning/scan_path.h"
#include "sim/scene.h"
#include "sim/surface_samples.h"

namespace nbs {

/// What a scan path of the oracle may be. Lengths in metres.
struct OraclePathSettings {
  int count = 6000;
  uint64_t seed = 1;
  double max_tilt_rad = 0.4363323129985824;  ///< 25 degrees, between the line of sight and the surface's normal.
  double min_standoff_m = 0.22;              ///< Of the path's middle from the point that it looks at.
  double max_standoff_m = 0.42;
  double min_length_m = 0.10;
  double max_length_m = 0.65;
  double clearance_m = 0.08;  ///< Kept all along between the sensor's body and the object.
};

/// The sensor's body and what it must not touch, beside the object itself.
struct OracleBody {
  std::vector<Sphere> spheres_S;
  std::optional<double> table_z_m;  ///< Top of the table, metres in W; none: no table.
};

/// True if all along the path (of one orientation) each sphere of the body stays `clearance_m` clear of the surface,
/// and above the table. The distance is followed in steps that it allows itself, so no gap between steps is passed
/// over; nearer to the limit than 0.5 mm counts as touching.
bool KeepsClear(const TriangleScene& object_W, const ScanPath& path, const OracleBody& body, double clearance_m);

/// Random straight scan paths around an object whose surface is known.
///
/// Each looks at a random sample from a random direction within max_tilt_rad of the normal (even in solid angle), its
/// middle a random stand-off away, runs along a random direction across the line of sight, and keeps clear of the
/// object; a draw that does not is drawn anew. Path i is a function of (seed, i): fewer paths are the first of more.
///
/// @returns settings.count paths of constant orientation.
/// @throws std::invalid_argument if there are no samples or the object leaves no room for path after path.
std::vector<ScanPath> MakeRandomScanPaths(const TriangleScene& object_W, std::span<const SurfaceSample> samples,
                                          const OracleBody& body, const OraclePathSettings& settings);

}  // namespace nbs
