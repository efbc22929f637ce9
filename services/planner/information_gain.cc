#include "services/planner/information_gain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

namespace nbs {
namespace {

/// Members of 0 .. count-1 that are first + k step.
int64_t CountSampled(int count, int step, int first) { return first < count ? (count - 1 - first) / step + 1 : 0; }

/// The middle of the first group of `step`, or what there is.
int CalcFirst(int count, int step) { return std::min(step / 2, count - 1); }

/// sum * all / sampled without overflow, rounded down.
int64_t Scale(int64_t sum, int64_t all, int64_t sampled) { return sum / sampled * all + sum % sampled * all / sampled; }

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

int64_t InformationGain::Calc(const GainMap& map, const ScanPath& path, GainSampling sampling) const {
  Workspace workspace = MakeWorkspace(map);
  return CalcPath(map, path, sampling, workspace);
}

int64_t InformationGain::CalcPath(const GainMap& map, const ScanPath& path, GainSampling sampling,
                                  Workspace& workspace) const {
  if (sampling.stripe_step < 1 || sampling.beam_step < 1)
    throw std::invalid_argument("InformationGain: a sampling step below 1");
  const int stripes = CountStripes(path);
  const int beams = static_cast<int>(beams_S_.size());
  const int first = CalcFirst(stripes, sampling.stripe_step);
  int64_t sum = 0;
  for (int i = first; i < stripes; i += sampling.stripe_step) {
    sum += CalcStripe(map, CalcStripePose(path, stripe_spacing_m_, i), sampling.beam_step, workspace);
  }
  const int64_t sampled = CountSampled(stripes, sampling.stripe_step, first) *
                          CountSampled(beams, sampling.beam_step, CalcFirst(beams, sampling.beam_step));
  return Scale(sum, static_cast<int64_t>(stripes) * beams, sampled);
}

std::vector<int64_t> InformationGain::CalcAll(const GainMap& map, std::span<const ScanPath> paths,
                                              GainSampling sampling, int threads) const {
  if (threads < 1) throw std::invalid_argument("InformationGain: " + std::to_string(threads) + " threads");
  if (sampling.stripe_step < 1 || sampling.beam_step < 1)
    throw std::invalid_argument("InformationGain: a sampling step below 1");
  std::vector<int64_t> gains(paths.size(), 0);
  // Each thread takes every threads-th path and writes to entries of its own.
  const auto work = [&](size_t first) {
    Workspace workspace = MakeWorkspace(map);
    for (size_t i = first; i < paths.size(); i += threads) gains[i] = CalcPath(map, paths[i], sampling, workspace);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work, i);
  work(0);
  helpers.clear();
  return gains;
}

std::vector<int64_t> InformationGain::CalcPerStripe(const GainMap& map, const ScanPath& path, int beam_step) const {
  if (beam_step < 1) throw std::invalid_argument("InformationGain: a sampling step below 1");
  const int stripes = CountStripes(path);
  const int beams = static_cast<int>(beams_S_.size());
  const int64_t sampled = CountSampled(beams, beam_step, CalcFirst(beams, beam_step));
  Workspace workspace = MakeWorkspace(map);
  std::vector<int64_t> gains;
  gains.reserve(stripes);
  for (int i = 0; i < stripes; ++i) {
    const Pose X_WS = CalcStripePose(path, stripe_spacing_m_, i);
    gains.push_back(Scale(CalcStripe(map, X_WS, beam_step, workspace), beams, sampled));
  }
  return gains;
}

Pose CalcStripePose(const ScanPath& path, double stripe_spacing_m, int i) {
  const double length = path.length_m();
  if (length <= 0.0) return path.X_WS_start;
  return Interpolate(path.X_WS_start, path.X_WS_end, i * stripe_spacing_m / length);
}

}  // namespace nbs
