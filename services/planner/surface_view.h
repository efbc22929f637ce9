#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/planner/surface_prediction.h"

namespace nbs {

/// Paths are ranked by every so many elements of the prediction, as good as by all.
inline constexpr uint32_t kRankingStep = 4;

/// An element of the prediction as a path sees it.
struct Sighting {
  uint32_t element = 0;                               ///< Its number.
  Eigen::Vector3f beam_W = Eigen::Vector3f::UnitZ();  ///< From the emitter to it, metres.
};

/// What a scan path would see of the predicted surface.
///
/// An element is seen if it comes into the light plane between start and end of the path, there within fan and depth of
/// field, under an incidence that the profiler can measure with `incidence_margin_rad` to spare (the prediction's
/// normal is a guess), and neither the laser's nor the camera's line of sight meets a wall of the prediction farther
/// than 20 mm in front of it. The path's orientation is that of its start: candidates do not turn.
class SurfaceView {
 public:
  explicit SurfaceView(const Profiler& profiler, double incidence_margin_rad = 0.1);

  /// Information gain of a path in nats: ln 2 for every voxel face of seen surface, by the trust in it
  /// (SurfacePrediction::CalcTrust), each counted once however many beams meet it; eq. 2 with the sum over the cells of
  /// a surface instead of over all cells along beams.
  ///
  /// @param voxel_m  Edge of a voxel.
  double CalcGain(const SurfacePrediction& prediction, const ScanPath& path, double voxel_m) const;

  /// The same of each path, evaluated by `threads` threads (>= 1); equal to CalcGain one by one.
  ///
  /// @param element_step  >= 1; only every so many elements are looked at, and the sum is scaled to all.
  std::vector<double> CalcGains(const SurfacePrediction& prediction, std::span<const ScanPath> paths, double voxel_m,
                                int threads, uint32_t element_step = 1) const;

  /// The elements that a path sees, by ascending number.
  std::vector<Sighting> FindSeen(const SurfacePrediction& prediction, const ScanPath& path) const;

 private:
  template <typename Visit>
  void VisitSeen(const SurfacePrediction& prediction, const ScanPath& path, uint32_t element_step, Visit&& visit) const;
  double CalcArea(const SurfacePrediction& prediction, const ScanPath& path, uint32_t element_step) const;

  float min_depth_m_ = 0.0f;
  float max_depth_m_ = 0.0f;
  float tan_half_fan_ = 0.0f;
  float min_cosine_ = 0.0f;
  float camera_baseline_m_ = 0.0f;
};

}  // namespace nbs
