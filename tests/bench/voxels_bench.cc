// The working map against OctoMap, on the same stripes and in the same run: MapUpdate folds ten scans, InformationGain
// rates a path of 44,800 beams in the map that five of them left. ratio_to_octomap: CPU time of OctoMap over ours.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/mapping/distance_field.h"
#include "services/planner/information_gain.h"
#include "services/voxelmap/map_update.h"
#include "tests/bench/octomap_peer.h"
#include "tests/bench/voxels_workload.h"

namespace nbs::bench {
namespace {

constexpr int kScans = 10;
constexpr int kScansBeforeGain = 5;

const MappingWorkload& Workload() {
  static const MappingWorkload workload = MakeMappingWorkload(kScans);
  return workload;
}

VoxelGrid MakeMap(int scans) {
  MapUpdate map(Workload().shape, Workload().profiler);
  for (int scan = 0; scan < scans; ++scan) {
    for (const Stripe& stripe : Workload().scans[scan]) map.Insert(stripe);
  }
  return map.grid();
}

/// What insertPointCloud does, under our names: a ray frees up to the cell before its point, a hit wins over the passes
/// of its stripe, every cell takes every pass.
InverseSensorModelSettings OctomapRules() {
  InverseSensorModelSettings settings;
  settings.free_margin_sigma = 0.0;
  settings.spare_occupied = false;
  return settings;
}

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
    octomap.Add(InsertByOctomap(Workload(), tree));
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
  const GainByOctomap theirs(tree, grid.shape(), Workload().profiler);
  Quickest octomap, ours;
  int64_t our_sum = 0, their_sum = 0;
  for (int i = 0; i < kOctomapRuns; ++i) {
    their_sum = 0;
    const double begin = CpuSeconds();
    for (const ScanPath& path : Workload().paths) their_sum += theirs.Calc(path, kAllBeams);
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

/// Time of a scan and memory of the map at half the resolution: 400 cubed cells.
void MapUpdateAtHalfTheResolution(benchmark::State& state) {
  const GridShape shape{Eigen::Vector3d::Constant(-0.5), 0.0025, Eigen::Vector3i::Constant(400)};
  Quickest ours;
  for (auto _ : state) {
    MapUpdate map(shape, Workload().profiler);
    const double begin = CpuSeconds();
    for (const std::vector<Stripe>& scan : Workload().scans) {
      for (const Stripe& stripe : scan) map.Insert(stripe);
    }
    ours.Add(CpuSeconds() - begin);
  }
  state.counters["ms_per_scan"] = 1e3 * ours.seconds / kScans;
}
BENCHMARK(MapUpdateAtHalfTheResolution)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
