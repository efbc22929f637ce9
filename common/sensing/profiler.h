#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose.h"

namespace nbs {

/// A laser stripe profiler after the triangulation principle.
///
/// Sensor frame S: origin at the laser's emitter; z is the viewing direction (the fan's middle), x lies along the
/// stripe, y is the normal of the light plane and the nominal scan direction. The camera stands at (0,
/// camera_baseline_m, 0) in S and sees the light plane from there.
struct Profiler {
  int points = 224;                    ///< Beams a stripe, >= 2.
  double rate_hz = 25.0;               ///< Stripes a second.
  double fan_rad = 0.872664625997165;  ///< Full angle between first and last beam (50 degrees).
  double min_depth_m = 0.150;          ///< Depth of field: of the point's z in S.
  double max_depth_m = 0.500;
  double standoff_m = 0.325;                      ///< Working distance.
  double sigma_base_m = 5e-5;                     ///< Noise along the beam: sigma(z) = sigma_base + sigma_per_m * z^2.
  double sigma_per_m = 2e-3;                      ///< 1/m.
  double max_incidence_rad = 1.2217304763960306;  ///< 70 degrees: a surface seen more obliquely gives no return.
  double camera_baseline_m = 0.0;                 ///< 0: the camera's line of sight is not modelled, and frees nothing.
  double scan_speed_m_per_s = 0.05;

  /// True if the camera's line of sight counts; a sensor rolled by half a turn then sees otherwise.
  bool HasCamera() const { return camera_baseline_m != 0.0; }

  bool operator==(const Profiler&) const = default;
};

/// Unit direction of beam `i` in S. Beams fan out evenly in angle from -fan/2 (towards -x) to +fan/2.
Eigen::Vector3d CalcBeamDirection_S(const Profiler& profiler, int i);

/// All beam directions, beam by beam.
std::vector<Eigen::Vector3d> CalcBeamDirections_S(const Profiler& profiler);

/// Where the camera stands in S, metres; at the emitter where it is not modelled.
Eigen::Vector3d CalcCamera_S(const Profiler& profiler);

/// Standard deviation of a range in metres, of a point at depth z (metres, along the z axis of S).
double CalcRangeSigma(const Profiler& profiler, double depth_m);

/// One profile as the instrument gives it. The instrument knows neither the robot's pose nor the number of the scan.
struct Profile {
  int64_t utime_us = 0;
  bool end_of_scan = false;     ///< True: closes the scan and has no ranges.
  std::vector<float> ranges_m;  ///< Along the beam, from the emitter; 0: no return.

  bool operator==(const Profile&) const = default;
};

/// Mesher and voxelmap publish what has changed after so many stripes of a scan, and at its end.
inline constexpr int kStripesPerDelta = 25;

/// One profile in its place in the world: what mesher and voxelmap fold.
struct Stripe {
  int64_t utime_us = 0;
  int32_t scan = 0;
  int32_t index = 0;         ///< Number within the scan, from 0.
  bool end_of_scan = false;  ///< True: closes the scan and has no ranges.
  Pose X_WS = Pose::Identity();
  std::vector<float> ranges_m;  ///< Along the beam, from the emitter; 0: no return, or out of the depth of field.
};

}  // namespace nbs
