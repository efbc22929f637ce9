#include "services/planner/information_gain.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "common/runtime/parallel.h"

namespace nbs {
namespace {

/// Members of 0 .. count-1 that are first + k step.
int64_t CountSampled(int count, int step, int first) { return first < count ? (count - 1 - first) / step + 1 : 0; }

/// The middle of the first group of `step`, or what there is.
int CalcFirst(int count, int step) { return std::min(step / 2, count - 1); }

/// sum * all / sampled without overflow, rounded down.
int64_t Scale(int64_t sum, int64_t all, int64_t sampled) { return sum / sampled * all + sum % sampled * all / sampled; }

void Check(GainSampling sampling, int threads) {
  if (sampling.stripe_step < 1 || sampling.beam_step < 1)
    throw std::invalid_argument("InformationGain: a sampling step below 1");
  if (threads < 1) throw std::invalid_argument("InformationGain: " + std::to_string(threads) + " threads");
}

}  // namespace

InformationGain::InformationGain(const Profiler& profiler, LaneSet lanes)
    : stripe_spacing_m_(profiler.scan_speed_m_per_s / profiler.rate_hz),
      max_depth_m_(profiler.max_depth_m),
      lanes_(lanes),
      beams_S_(CalcBeamDirections_S(profiler)) {
  for (Eigen::Vector3d& beam_S : beams_S_) beam_S *= max_depth_m_ / beam_S.z();
}

int InformationGain::CountStripes(const ScanPath& path) const {
  // A whole number of spacings counts its last stripe although the division may fall just short of it.
  return static_cast<int>(std::floor(path.length_m() / stripe_spacing_m_ + 1e-6)) + 1;
}

int64_t InformationGain::CountBeams(const ScanPath& path) const {
  return CountStripes(path) * static_cast<int64_t>(beams_S_.size());
}

int64_t InformationGain::CalcStripe(const GainMap& map, const Pose& X_WS, int beam_step, Workspace& workspace) const {
  const int beams = static_cast<int>(beams_S_.size());
  workspace.ends_W.clear();
  for (int i = CalcFirst(beams, beam_step); i < beams; i += beam_step) workspace.ends_W.push_back(X_WS * beams_S_[i]);
  workspace.rays.Set(X_WS.translation(), workspace.ends_W, LastCell::kIncluded);
  return workspace.rays.Sum(map.values().data()) * map.unit();
}

int64_t InformationGain::Calc(const GainMap& map, const ScanPath& path, GainSampling sampling, int threads) const {
  Check(sampling, threads);
  std::vector<int64_t> sums(threads, 0);
  RunOnThreads(threads, [&](int thread) {
    Workspace workspace = MakeWorkspace(map);
    sums[thread] = SumPart(map, path, sampling, threads, thread, workspace);
  });
  return ScaleUp(std::reduce(sums.begin(), sums.end()), path, sampling);
}

int64_t InformationGain::SumPart(const GainMap& map, const ScanPath& path, GainSampling sampling, int threads,
                                 int thread, Workspace& workspace) const {
  const int stripes = CountStripes(path);
  int64_t sum = 0;
  for (int i = CalcFirst(stripes, sampling.stripe_step) + thread * sampling.stripe_step; i < stripes;
       i += threads * sampling.stripe_step) {
    sum += CalcStripe(map, CalcStripePose(path, stripe_spacing_m_, i), sampling.beam_step, workspace);
  }
  return sum;
}

int64_t InformationGain::ScaleUp(int64_t sum, const ScanPath& path, GainSampling sampling) const {
  const int stripes = CountStripes(path), beams = static_cast<int>(beams_S_.size());
  const int64_t sampled = CountSampled(stripes, sampling.stripe_step, CalcFirst(stripes, sampling.stripe_step)) *
                          CountSampled(beams, sampling.beam_step, CalcFirst(beams, sampling.beam_step));
  return Scale(sum, static_cast<int64_t>(stripes) * beams, sampled);
}

std::vector<int64_t> InformationGain::CalcAll(const GainMap& map, std::span<const ScanPath> paths,
                                              GainSampling sampling, int threads) const {
  Check(sampling, threads);
  std::vector<int64_t> gains(paths.size(), 0);
  // Each thread takes every threads-th path and writes to entries of its own.
  RunOnThreads(threads, [&](int thread) {
    Workspace workspace = MakeWorkspace(map);
    for (size_t i = thread; i < paths.size(); i += threads)
      gains[i] = ScaleUp(SumPart(map, paths[i], sampling, 1, 0, workspace), paths[i], sampling);
  });
  return gains;
}

Pose CalcStripePose(const ScanPath& path, double stripe_spacing_m, int i) {
  const double length = path.length_m();
  if (length <= 0.0) return path.X_WS_start;
  return Interpolate(path.X_WS_start, path.X_WS_end, i * stripe_spacing_m / length);
}

}  // namespace nbs
