#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/triangle_mesh.h"
#include "common/sensing/profiler.h"
#include "sim/scene.h"
#include "sim/surface_samples.h"

namespace nbs {

/// From so many directions, even over the sphere, and along the normal it is asked whether a point can be seen.
inline constexpr int kSightDirections = 256;

struct CoverageSettings {
  int samples = 100000;
  double max_distance_m = 0.002;              ///< Between a sample and its partner in the reconstruction.
  double max_angle_rad = 1.3089969389957472;  ///< 75 degrees, between their normals.
  Profiler profiler;                          ///< Its nearest depth and largest incidence say what can be observed.
  std::optional<double> table_z_m;            ///< The sensor stays above it; none: it may look from anywhere.
};

struct Coverage {
  double coverage = 0.0;             ///< Share of the truth's samples that have a partner: c_o of the paper.
  double observable_coverage = 0.0;  ///< The same among the samples that can be observed at all; 0 if none can.
  double rmse_m =
      0.0;  ///< Root mean square distance of the reconstruction's vertices from the truth; 0 without triangles.
};

/// Compares reconstructions with the true object (section IV of the paper).
///
/// The truth is sampled evenly by area, the same on every run. A sample is covered if the reconstruction's surface has
/// a point within max_distance_m of it where the normal agrees within max_angle_rad: wrong sides of thin parts do not
/// count. A sample can be observed if from some direction, no more oblique than the profiler's largest incidence, the
/// nearest depth of the depth of field is free of the object, and ends above the table. (The directions are tried from
/// a fixed set of 256; neither the sensor's body nor the camera's line of sight is looked at.)
class CoverageOracle {
 public:
  /// @param truth_W  Triangles counter-clockwise seen from outside.
  /// @throws std::invalid_argument if the truth has no area or samples < 1.
  CoverageOracle(const TriangleMesh& truth_W, const CoverageSettings& settings);

  /// Share of the truth's surface that can be observed.
  double observable_share() const { return observable_share_; }

  const std::vector<SurfaceSample>& samples() const { return samples_; }
  const TriangleScene& truth_W() const { return truth_W_; }

  /// For each sample 1 if it has a partner in the reconstruction, else 0.
  std::vector<uint8_t> FindCovered(const TriangleMesh& mesh_W) const;

  /// @param mesh_W  The reconstruction; only vertices that a triangle uses count for the RMS error.
  Coverage Evaluate(const TriangleMesh& mesh_W) const;

 private:
  void FindObservable();
  double CalcRmse(const TriangleMesh& mesh_W) const;

  CoverageSettings settings_;
  TriangleScene truth_W_;
  std::vector<SurfaceSample> samples_;
  std::vector<uint8_t> observable_;  ///< One a sample.
  double observable_share_ = 0.0;
};

}  // namespace nbs
