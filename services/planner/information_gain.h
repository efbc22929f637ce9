#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mapping/ray_bundle.h"
#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"
#include "services/planner/gain_map.h"

namespace nbs {

/// Which beams of a scan path are evaluated: every `stripe_step`-th stripe and every `beam_step`-th beam, from the
/// middle of the first group; the sum is scaled to all beams.
struct GainSampling {
  int stripe_step = 1;
  int beam_step = 1;
};

/// All beams: for the final choice.
inline constexpr GainSampling kAllBeams = {1, 1};
/// A sixty-fourth of the beams: for ranking.
inline constexpr GainSampling kSixtyFourth = {8, 8};

/// The information gain of scan paths (section III-D, eq. 2): the sum over all beams of a path, and over the cells
/// along each beam from the emitter to the largest depth, of the cell's entropy (eq. 1). A beam ends before the first
/// occupied cell; what is outside the grid is known to be free and adds nothing.
///
/// Gains are integers in 1/65536 nat (kEntropyPerNat): the result depends neither on the order of the beams nor on
/// threads.
class InformationGain {
 public:
  /// @param lanes  Instruction set; the gain is the same with each.
  explicit InformationGain(const Profiler& profiler, LaneSet lanes = FindWidestLanes());

  /// Stripes that the profiler takes along a path: one every scan_speed / rate metres from the start on, at least one.
  int CountStripes(const ScanPath& path) const;

  /// Beams of all those stripes.
  int64_t CountBeams(const ScanPath& path) const;

  /// Gain of a path, its stripes shared out among `threads` threads (>= 1).
  ///
  /// @throws std::invalid_argument if a step of the sampling or the number of threads is not positive.
  int64_t Calc(const GainMap& map, const ScanPath& path, GainSampling sampling, int threads = 1) const;

  /// The same of each path, evaluated by `threads` threads (>= 1); equal to Calc one by one.
  std::vector<int64_t> CalcAll(const GainMap& map, std::span<const ScanPath> paths, GainSampling sampling,
                               int threads) const;

 private:
  /// What evaluating one path after the other needs again and again.
  struct Workspace {
    RayBundle rays;
    std::vector<Eigen::Vector3d> ends_W;
  };
  Workspace MakeWorkspace(const GainMap& map) const { return {RayBundle(map.shape(), lanes_), {}}; }
  /// The part of a path that comes to one of `threads` threads: the sum over its sampled beams.
  int64_t SumPart(const GainMap& map, const ScanPath& path, GainSampling sampling, int threads, int thread,
                  Workspace& workspace) const;
  /// The gain of a path from the sum over its sampled beams.
  int64_t ScaleUp(int64_t sum, const ScanPath& path, GainSampling sampling) const;
  int64_t CalcStripe(const GainMap& map, const Pose& X_WS, int beam_step, Workspace& workspace) const;

  double stripe_spacing_m_ = 0.0;
  double max_depth_m_ = 0.0;
  LaneSet lanes_;
  std::vector<Eigen::Vector3d> beams_S_;  ///< From the emitter to the largest depth, metres.
};

/// Sensor pose of stripe `i` of a path: `i` stripe spacings behind its start.
Pose CalcStripePose(const ScanPath& path, double stripe_spacing_m, int i);

/// A gain in nats.
inline double ToNats(int64_t gain) { return static_cast<double>(gain) / kEntropyPerNat; }

}  // namespace nbs
