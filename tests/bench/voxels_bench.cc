// The working map against OctoMap, on the same stripes and in the same run: MapUpdate folds ten scans, InformationGain
// rates a path of 44,800 beams in the map that five of them left. ratio_to_octomap: CPU time of OctoMap over ours.

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <string>

#include "common/mapping/distance_field.h"
#include "common/mapping/ray_walk.h"
#include "common/runtime/counter_random.h"
#include "services/planner/information_gain.h"
#include "services/voxelmap/map_update.h"
#include "tests/bench/voxels_workload.h"

namespace nbs::bench {
namespace {

constexpr int kScans = 10;
constexpr int kScansBeforeGain = 5;

const MappingWorkload& Workload() {
  static const MappingWorkload workload = MakeMappingWorkload(kScans);
  return workload;
}

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

VoxelGrid MakeMap(int scans) {
  MapUpdate map(Workload().shape, Workload().profiler);
  for (int scan = 0; scan < scans; ++scan) {
    for (const Stripe& stripe : Workload().scans[scan]) map.Insert(stripe);
  }
  return map.grid();
}

/// OctoMap with our weights: each of them is a whole number of 1/1024 nat and so exact in its single precision.
class TreeOfOurModel : public octomap::OcTree {
 public:
  explicit TreeOfOurModel(double resolution_m) : octomap::OcTree(resolution_m) {
    const LogOddsSteps steps = MakeLogOddsSteps({});
    prob_hit_log = static_cast<float>(steps.hit / kLogOddsPerNat);
    prob_miss_log = static_cast<float>(-steps.miss / kLogOddsPerNat);
    clamping_thres_min = static_cast<float>(steps.lowest / kLogOddsPerNat);
    clamping_thres_max = static_cast<float>(steps.highest / kLogOddsPerNat);
    occ_prob_thres_log = static_cast<float>(kOccupiedLogOdds / kLogOddsPerNat);
  }
};

/// What insertPointCloud does, under our names: a ray frees up to the cell before its point, a hit wins over the passes
/// of its stripe, every cell takes every pass.
InverseSensorModelSettings OctomapRules() {
  InverseSensorModelSettings settings;
  settings.free_margin_sigma = 0.0;
  settings.spare_occupied = false;
  return settings;
}

/// OctoMap's best way: one cloud per stripe, lazily, inner nodes brought up to date once at the end. Returns CPU
/// seconds.
double InsertByOctomap(octomap::OcTree& tree) {
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(Workload().profiler);
  const double begin = CpuSeconds();
  for (const std::vector<Stripe>& scan : Workload().scans) {
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

/// Cells of the grid that were observed, and those where the tree says something else.
struct Comparison {
  int64_t observed = 0;
  int64_t different = 0;           ///< Another log-odds.
  int64_t different_in_class = 0;  ///< Occupied in one of the two only, or never observed in one of the two only.
};

Comparison Compare(const VoxelGrid& grid, const octomap::OcTree& tree) {
  Comparison comparison;
  const Eigen::Vector3i first = (grid.shape().origin_W / grid.shape().resolution_m).array().round().cast<int>() + 32768;
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

/// A tree with the observed cells of the grid.
octomap::OcTree MakeTree(const VoxelGrid& grid) {
  octomap::OcTree tree(grid.shape().resolution_m);
  tree.setClampingThresMin(1e-9);
  tree.setClampingThresMax(1.0 - 1e-9);
  const Eigen::Vector3i first = (grid.shape().origin_W / grid.shape().resolution_m).array().round().cast<int>() + 32768;
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

/// Eq. 2 on OctoMap in one pass: computeRayKeys, search, entropies from the same table.
class GainByOctomap {
 public:
  GainByOctomap(const octomap::OcTree& tree, const GridShape& shape)
      : tree_(tree),
        first_((shape.origin_W / shape.resolution_m).array().round().cast<int>() + 32768),
        last_(first_ + shape.size) {}

  int64_t Calc(const Profiler& profiler, const ScanPath& path) {
    const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(profiler);
    int64_t sum = 0;
    for (int i = 0; i < InformationGain(profiler).CountStripes(path); ++i) {
      const Pose X_WS = CalcStripePose(path, profiler.scan_speed_m_per_s / profiler.rate_hz, i);
      const Eigen::Vector3f a = X_WS.translation().cast<float>();
      for (const Eigen::Vector3d& beam_S : directions_S) {
        const Eigen::Vector3f b = (X_WS * (beam_S * profiler.max_depth_m / beam_S.z())).cast<float>();
        sum += CalcRay({a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()});
      }
    }
    return sum;
  }

 private:
  int64_t CalcRay(const octomap::point3d& a, const octomap::point3d& b) {
    int64_t sum = 0;
    tree_.computeRayKeys(a, b, ray_);
    // The ray ends before the last cell.
    ray_.addKey(tree_.coordToKey(b));
    for (const octomap::OcTreeKey& key : ray_) {
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

  const octomap::OcTree& tree_;
  Eigen::Vector3i first_, last_;  ///< Keys of the grid's first cell and of the one behind its last.
  octomap::KeyRay ray_;
};

constexpr int kOctomapRuns = 3;

/// The quickest of several runs: the machine may be busy with other work, for OctoMap as for us.
struct Quickest {
  double seconds = std::numeric_limits<double>::infinity();
  void Add(double s) { seconds = std::min(seconds, s); }
};

/// Folds all scans under OctoMap's rules with the given lanes, and compares every cell.
void RunMapUpdate(benchmark::State& state, LaneSet lanes) {
  Quickest octomap, ours;
  TreeOfOurModel tree(Workload().shape.resolution_m);
  for (int i = 0; i < kOctomapRuns; ++i) {
    tree.clear();
    octomap.Add(InsertByOctomap(tree));
  }
  Comparison comparison;
  for (auto _ : state) {
    state.PauseTiming();
    MapUpdate map(Workload().shape, Workload().profiler, OctomapRules(), lanes);
    state.ResumeTiming();
    const double begin = CpuSeconds();
    for (const std::vector<Stripe>& scan : Workload().scans) {
      for (const Stripe& stripe : scan) map.Insert(stripe);
    }
    ours.Add(CpuSeconds() - begin);
    state.PauseTiming();
    if (comparison.observed == 0) comparison = Compare(map.grid(), tree);
    state.ResumeTiming();
  }
  state.SetLabel(std::string(ToString(lanes)));
  state.counters["returning_beams_per_s"] = static_cast<double>(Workload().returns) / ours.seconds;
  state.counters["octomap_beams_per_s"] = static_cast<double>(Workload().returns) / octomap.seconds;
  state.counters["ratio_to_octomap"] = octomap.seconds / ours.seconds;
  state.counters["cells_observed"] = static_cast<double>(comparison.observed);
  state.counters["cells_different"] = static_cast<double>(comparison.different);
  state.counters["cells_different_in_class"] = static_cast<double>(comparison.different_in_class);
  // OctoMap keeps points and directions in single precision: now and then a crossing falls the other way.
  if (comparison.different > comparison.observed / 100000) state.SkipWithError("the maps disagree");
}

void MapUpdateBench(benchmark::State& state) { RunMapUpdate(state, FindWidestLanes()); }
BENCHMARK(MapUpdateBench)->Name("MapUpdate")->Unit(benchmark::kMillisecond);

/// The same with each instruction set that there is: 0 sse4.2, 1 avx2, 2 avx512.
void MapUpdateByLanes(benchmark::State& state) {
  const LaneSet lanes = kLaneSets.at(state.range(0));
  if (!IsSupported(lanes)) return state.SkipWithError("not on this processor");
  RunMapUpdate(state, lanes);
}
BENCHMARK(MapUpdateByLanes)->DenseRange(0, kLaneSets.size() - 1)->Unit(benchmark::kMillisecond);

/// The service's own rules (margin before the point, occupied cells spared), changes collected as it does.
void MapUpdateAsServed(benchmark::State& state) {
  Quickest ours;
  for (auto _ : state) {
    state.PauseTiming();
    MapUpdate map(Workload().shape, Workload().profiler);
    state.ResumeTiming();
    const double begin = CpuSeconds();
    for (const std::vector<Stripe>& scan : Workload().scans) {
      for (size_t i = 0; i < scan.size(); ++i) {
        map.Insert(scan[i]);
        if (i % 25 == 24) benchmark::DoNotOptimize(map.TakeDelta());
      }
    }
    ours.Add(CpuSeconds() - begin);
  }
  state.counters["ms_per_scan"] = 1e3 * ours.seconds / kScans;
  state.counters["returning_beams_per_s"] = static_cast<double>(Workload().returns) / ours.seconds;
}
BENCHMARK(MapUpdateAsServed)->Unit(benchmark::kMillisecond);

/// Rates all paths with every beam, and compares the sums.
void RunInformationGain(benchmark::State& state, LaneSet lanes) {
  const VoxelGrid grid = MakeMap(kScansBeforeGain);
  const InformationGain gain(Workload().profiler, lanes);
  const GainMap map(grid);
  const octomap::OcTree tree = MakeTree(grid);
  GainByOctomap theirs(tree, grid.shape());
  Quickest octomap, ours;
  int64_t our_sum = 0, their_sum = 0;
  for (int i = 0; i < kOctomapRuns; ++i) {
    their_sum = 0;
    const double begin = CpuSeconds();
    for (const ScanPath& path : Workload().paths) their_sum += theirs.Calc(Workload().profiler, path);
    octomap.Add(CpuSeconds() - begin);
  }
  for (auto _ : state) {
    our_sum = 0;
    const double begin = CpuSeconds();
    for (const ScanPath& path : Workload().paths) our_sum += gain.Calc(map, path, kAllBeams);
    ours.Add(CpuSeconds() - begin);
  }
  const double difference = std::abs(static_cast<double>(our_sum - their_sum)) / static_cast<double>(our_sum);
  if (difference > 1e-4) state.SkipWithError("the gains disagree");
  const auto paths = static_cast<double>(Workload().paths.size());
  state.SetLabel(std::string(ToString(lanes)));
  state.counters["ms_per_path"] = 1e3 * ours.seconds / paths;
  state.counters["octomap_ms_per_path"] = 1e3 * octomap.seconds / paths;
  state.counters["ratio_to_octomap"] = octomap.seconds / ours.seconds;
  state.counters["difference_of_the_sums"] = difference;
}

void InformationGainBench(benchmark::State& state) { RunInformationGain(state, FindWidestLanes()); }
BENCHMARK(InformationGainBench)->Name("InformationGain")->Unit(benchmark::kMillisecond);

/// The same with each instruction set that there is: 0 sse4.2, 1 avx2, 2 avx512.
void InformationGainByLanes(benchmark::State& state) {
  const LaneSet lanes = kLaneSets.at(state.range(0));
  if (!IsSupported(lanes)) return state.SkipWithError("not on this processor");
  RunInformationGain(state, lanes);
}
BENCHMARK(InformationGainByLanes)->DenseRange(0, kLaneSets.size() - 1)->Unit(benchmark::kMillisecond);

/// Both fields of a 0.6 m box, as after every scan.
void DistanceFieldBench(benchmark::State& state) {
  const GridShape shape{Eigen::Vector3d::Constant(-0.3), 0.005, Eigen::Vector3i::Constant(120)};
  MapUpdate map(shape, Workload().profiler);
  for (int scan = 0; scan < kScansBeforeGain; ++scan) {
    for (const Stripe& stripe : Workload().scans[scan]) map.Insert(stripe);
  }
  for (auto _ : state) {
    const DistanceField to_occupied(map.grid(), Obstacles::kOccupied),
        to_unknown(map.grid(), Obstacles::kOccupiedOrUnknown);
    benchmark::DoNotOptimize(to_occupied.CalcDistance(Eigen::Vector3d::Zero()));
    benchmark::DoNotOptimize(to_unknown.CalcDistance(Eigen::Vector3d::Zero()));
  }
}
BENCHMARK(DistanceFieldBench)->Name("DistanceField")->Unit(benchmark::kMillisecond);

/// Marks the cells that returns of the scans lie in.
std::vector<uint8_t> MarkHits(const MappingWorkload& workload) {
  std::vector<uint8_t> marks(workload.shape.cells(), 0);
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(workload.profiler);
  for (const std::vector<Stripe>& scan : workload.scans) {
    for (const Stripe& stripe : scan) {
      for (const Eigen::Vector3d& p_W : CalcStripeEvidence(workload.profiler, directions_S, 3.0, stripe).hits_W) {
        if (const int64_t index = FindCell(workload.shape, p_W); index >= 0) marks[index] = 1;
      }
    }
  }
  return marks;
}

bool MeetsOccupied(const VoxelGrid& grid, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) {
  bool meets = false;
  WalkRay(MakeRayWalk(grid.shape(), p_WA, p_WB),
          [&](int64_t index) { return !(meets = IsOccupied(grid.cells()[index])); });
  return meets;
}

/// Share of the beams from new directions at surface whose cell was hit by a scan, or has a neighbour that was, that
/// meet nothing occupied up to 50 mm behind it.
double CalcShineThrough(const MappingWorkload& workload, const VoxelGrid& grid) {
  const std::vector<uint8_t> marks = MarkHits(workload);
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(workload.profiler);
  int64_t beams = 0, shining = 0;
  for (uint64_t i = 0; i < 1200; ++i) {
    const std::vector<Stripe>& scan = workload.scans[i % workload.scans.size()];
    const Eigen::Vector3d axis(CalcGaussian({i, 0}), CalcGaussian({i, 1}), CalcGaussian({i, 2}));
    const Eigen::AngleAxisd turn(0.6 * CalcGaussian({i, 3}), axis.normalized());
    const Stripe fresh = CastStripe(workload.profiler, workload.figure, turn * scan[i * 37 % scan.size()].X_WS);
    for (size_t beam = 0; beam < directions_S.size(); ++beam) {
      if (fresh.ranges_m[beam] == 0.0F) continue;
      const Eigen::Vector3d p_WP = fresh.X_WS * (fresh.ranges_m[beam] * directions_S[beam]);
      bool scanned = false;
      for (int n = 0; n < 27; ++n) {
        const int64_t index =
            FindCell(workload.shape, p_WP + 0.005 * Eigen::Vector3d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        scanned |= index >= 0 && marks[index] != 0;
      }
      if (!scanned) continue;
      ++beams;
      shining += !MeetsOccupied(grid, fresh.X_WS.translation(),
                                fresh.X_WS * ((fresh.ranges_m[beam] + 0.05) * directions_S[beam]));
    }
  }
  return static_cast<double>(shining) / static_cast<double>(beams);
}

/// Quality, not speed: how closed the surface is after twenty scans.
void ShineThroughBench(benchmark::State& state) {
  const MappingWorkload workload = MakeMappingWorkload(20);
  MapUpdate map(workload.shape, workload.profiler);
  int64_t cells = 0, runs = 0;
  for (const std::vector<Stripe>& scan : workload.scans) {
    for (size_t i = 0; i < scan.size(); ++i) {
      map.Insert(scan[i]);
      if (i % 25 != 24) continue;
      const VoxelDelta delta = map.TakeDelta();
      cells += static_cast<int64_t>(delta.values.size());
      runs += static_cast<int64_t>(delta.run_start.size());
    }
  }
  for (auto _ : state) state.counters["shine_through_percent"] = 100.0 * CalcShineThrough(workload, map.grid());
  state.counters["delta_cells_per_scan"] = static_cast<double>(cells) / 20.0;
  state.counters["delta_runs_per_scan"] = static_cast<double>(runs) / 20.0;
}
BENCHMARK(ShineThroughBench)->Name("ShineThrough")->Unit(benchmark::kMillisecond)->Iterations(1);

/// One query, along a line through the field as a moving body asks.
void DistanceQueryBench(benchmark::State& state) {
  const DistanceField field(MakeMap(kScansBeforeGain), Obstacles::kOccupiedOrUnknown);
  Eigen::Vector3d p_W(-0.5, -0.2, 0.1);
  double sum = 0.0;
  for (auto _ : state) {
    p_W.x() = p_W.x() > 0.5 ? -0.5 : p_W.x() + 0.0007;
    sum += field.CalcDistance(p_W);
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(DistanceQueryBench)->Name("DistanceQuery")->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
