#include "tests/bench/octomap_peer.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <thread>

namespace nbs::bench {
namespace {

/// OctoMap's key of the grid's first cell.
Eigen::Vector3i CalcFirstKey(const GridShape& shape) {
  return (shape.origin_W / shape.resolution_m).array().round().cast<int>() + 32768;
}

}  // namespace

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double InsertByOctomap(const MappingWorkload& workload, octomap::OcTree& tree) {
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(workload.profiler);
  const double begin = CpuSeconds();
  for (const std::vector<Stripe>& scan : workload.scans) {
    for (const Stripe& stripe : scan) {
      octomap::Pointcloud cloud;
      for (size_t i = 0; i < stripe.ranges_m.size(); ++i) {
        if (stripe.ranges_m[i] == 0.0F) continue;
        const Eigen::Vector3f p_W = (stripe.X_WS * (stripe.ranges_m[i] * directions_S[i])).cast<float>();
        cloud.push_back(p_W.x(), p_W.y(), p_W.z());
      }
      const Eigen::Vector3f p_WS = stripe.X_WS.translation().cast<float>();
      tree.insertPointCloud(cloud, {p_WS.x(), p_WS.y(), p_WS.z()}, -1.0, true);
    }
  }
  tree.updateInnerOccupancy();
  return CpuSeconds() - begin;
}

Comparison Compare(const VoxelGrid& grid, const octomap::OcTree& tree) {
  Comparison comparison;
  const Eigen::Vector3i first = CalcFirstKey(grid.shape());
  for (int z = 0; z < grid.shape().size.z(); ++z) {
    for (int y = 0; y < grid.shape().size.y(); ++y) {
      for (int x = 0; x < grid.shape().size.x(); ++x) {
        const int16_t ours = grid.At(x, y, z);
        const octomap::OcTreeNode* node = tree.search(octomap::OcTreeKey(first.x() + x, first.y() + y, first.z() + z));
        const int16_t theirs =
            node == nullptr ? kUnobserved : static_cast<int16_t>(std::lround(node->getLogOdds() * kLogOddsPerNat));
        comparison.observed += ours != kUnobserved;
        comparison.different += ours != theirs;
        comparison.different_in_class +=
            IsOccupied(ours) != IsOccupied(theirs) || (ours == kUnobserved) != (theirs == kUnobserved);
      }
    }
  }
  return comparison;
}

octomap::OcTree MakeTree(const VoxelGrid& grid) {
  octomap::OcTree tree(grid.shape().resolution_m);
  tree.setClampingThresMin(1e-9);
  tree.setClampingThresMax(1.0 - 1e-9);
  const Eigen::Vector3i first = CalcFirstKey(grid.shape());
  for (int z = 0; z < grid.shape().size.z(); ++z) {
    for (int y = 0; y < grid.shape().size.y(); ++y) {
      for (int x = 0; x < grid.shape().size.x(); ++x) {
        const int16_t log_odds = grid.At(x, y, z);
        if (log_odds == kUnobserved) continue;
        const octomap::OcTreeKey key(first.x() + x, first.y() + y, first.z() + z);
        tree.setNodeValue(key, static_cast<float>(log_odds / kLogOddsPerNat), true);
      }
    }
  }
  tree.updateInnerOccupancy();
  return tree;
}

void Apply(const VoxelDelta& delta, const GridShape& shape, octomap::OcTree& tree) {
  const Eigen::Vector3i first = CalcFirstKey(shape);
  size_t value = 0;
  for (size_t run = 0; run < delta.run_start.size(); ++run) {
    for (int64_t index = delta.run_start[run]; index < int64_t{delta.run_start[run]} + delta.run_length[run]; ++index) {
      const int64_t row = index / shape.size.x();
      const octomap::OcTreeKey key(static_cast<uint16_t>(first.x() + index % shape.size.x()),
                                   static_cast<uint16_t>(first.y() + row % shape.size.y()),
                                   static_cast<uint16_t>(first.z() + row / shape.size.y()));
      tree.setNodeValue(key, static_cast<float>(delta.values[value++] / kLogOddsPerNat), true);
    }
  }
}

GainByOctomap::GainByOctomap(const octomap::OcTree& tree, const GridShape& shape, const Profiler& profiler)
    : tree_(tree),
      first_(CalcFirstKey(shape)),
      last_(first_ + shape.size),
      profiler_(profiler),
      count_(profiler),
      directions_S_(CalcBeamDirections_S(profiler)) {}

int64_t GainByOctomap::Calc(const ScanPath& path, GainSampling sampling, int threads) const {
  const int stripes = count_.CountStripes(path), beams = profiler_.points;
  std::vector<int64_t> sums(threads, 0);
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back([&, i] { sums[i] = SumPart(path, sampling, threads, i); });
    sums[0] = SumPart(path, sampling, threads, 0);
  }
  const auto count = [](int all, int step) { return (all - 1 - std::min(step / 2, all - 1)) / step + 1; };
  const int64_t sum = std::reduce(sums.begin(), sums.end()), all = static_cast<int64_t>(stripes) * beams;
  const int64_t sampled = int64_t{count(stripes, sampling.stripe_step)} * count(beams, sampling.beam_step);
  return sum / sampled * all + sum % sampled * all / sampled;
}

int64_t GainByOctomap::SumPart(const ScanPath& path, GainSampling sampling, int threads, int thread) const {
  octomap::KeyRay ray;
  const int stripes = count_.CountStripes(path), beams = profiler_.points;
  int64_t sum = 0;
  for (int i = std::min(sampling.stripe_step / 2, stripes - 1) + thread * sampling.stripe_step; i < stripes;
       i += threads * sampling.stripe_step) {
    const Pose X_WS = CalcStripePose(path, profiler_.scan_speed_m_per_s / profiler_.rate_hz, i);
    const Eigen::Vector3f a = X_WS.translation().cast<float>();
    for (int k = std::min(sampling.beam_step / 2, beams - 1); k < beams; k += sampling.beam_step) {
      const Eigen::Vector3d& beam_S = directions_S_[k];
      const Eigen::Vector3f b = (X_WS * (beam_S * profiler_.max_depth_m / beam_S.z())).cast<float>();
      sum += CalcRay({a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, ray);
    }
  }
  return sum;
}

std::vector<int64_t> GainByOctomap::CalcAll(std::span<const ScanPath> paths, GainSampling sampling, int threads) const {
  std::vector<int64_t> gains(paths.size(), 0);
  const auto work = [&](size_t first) {
    for (size_t i = first; i < paths.size(); i += threads) gains[i] = Calc(paths[i], sampling);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work, i);
  work(0);
  helpers.clear();
  return gains;
}

int64_t GainByOctomap::CalcRay(const octomap::point3d& a, const octomap::point3d& b, octomap::KeyRay& ray) const {
  int64_t sum = 0;
  tree_.computeRayKeys(a, b, ray);
  // The ray ends before the last cell.
  ray.addKey(tree_.coordToKey(b));
  for (const octomap::OcTreeKey& key : ray) {
    const Eigen::Vector3i k(key[0], key[1], key[2]);
    if ((k.array() < first_.array()).any() || (k.array() >= last_.array()).any()) continue;
    const octomap::OcTreeNode* node = tree_.search(key);
    const int16_t log_odds =
        node == nullptr ? kUnobserved : static_cast<int16_t>(std::lround(node->getLogOdds() * kLogOddsPerNat));
    if (IsOccupied(log_odds)) break;
    sum += EntropyTable()[static_cast<uint16_t>(log_odds)];
  }
  return sum;
}

}  // namespace nbs::bench
