// The working map against OctoMap, on the same stripes and in the same run: MapUpdate folds ten scans, InformationGain
// rates a path of 44,800 beams in the map that five of them left. ratio_to_octomap: CPU time of OctoMap over ours.

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <ctime>

#include "common/mapping/distance_field.h"
#include "common/mapping/ray_walk.h"
#include "common/runtime/counter_random.h"
#include "services/planner/information_gain.h"
#include "services/voxelmap/map_update.h"
#include "tests/bench/mapping_workload.h"

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

/// OctoMap's own update: one cloud per stripe, inner nodes brought up to date once at the end.
void InsertByOctomap(octomap::OcTree& tree) {
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(Workload().profiler);
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
}

double CalcOctomapUpdateSeconds() {
  octomap::OcTree tree(Workload().shape.resolution_m);
  tree.setOccupancyThres(0.95);
  tree.setClampingThresMin(0.007);
  tree.setClampingThresMax(0.993);
  const double begin = CpuSeconds();
  InsertByOctomap(tree);
  return CpuSeconds() - begin;
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

/// Eq. 2 on OctoMap in one pass, entropies from the same table.
int64_t CalcGainByOctomap(const octomap::OcTree& tree, const GridShape& shape, const Profiler& profiler,
                          const ScanPath& path) {
  const Eigen::Vector3i first = (shape.origin_W / shape.resolution_m).array().round().cast<int>() + 32768;
  const Eigen::Vector3i last = first + shape.size;
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(profiler);
  octomap::KeyRay ray;
  int64_t sum = 0;
  for (int i = 0; i < InformationGain(profiler).CountStripes(path); ++i) {
    const Pose X_WS = CalcStripePose(path, profiler.scan_speed_m_per_s / profiler.rate_hz, i);
    const Eigen::Vector3f a = X_WS.translation().cast<float>();
    for (const Eigen::Vector3d& beam_S : directions_S) {
      const Eigen::Vector3f b = (X_WS * (beam_S * profiler.max_depth_m / beam_S.z())).cast<float>();
      tree.computeRayKeys({a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, ray);
      for (const octomap::OcTreeKey& key : ray) {
        const Eigen::Vector3i k(key[0], key[1], key[2]);
        if ((k.array() < first.array()).any() || (k.array() >= last.array()).any()) continue;
        const octomap::OcTreeNode* node = tree.search(key);
        const int16_t log_odds =
            node == nullptr ? kUnobserved : static_cast<int16_t>(std::lround(node->getLogOdds() * kLogOddsPerNat));
        if (IsOccupied(log_odds)) break;
        sum += EntropyTable()[static_cast<uint16_t>(log_odds)];
      }
    }
  }
  return sum;
}

void MapUpdateBench(benchmark::State& state) {
  const double octomap_seconds = CalcOctomapUpdateSeconds();
  double seconds = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    MapUpdate map(Workload().shape, Workload().profiler);
    state.ResumeTiming();
    const double begin = CpuSeconds();
    for (const std::vector<Stripe>& scan : Workload().scans) {
      for (const Stripe& stripe : scan) map.Insert(stripe);
    }
    seconds += CpuSeconds() - begin;
    benchmark::DoNotOptimize(map.grid().cells().data());
  }
  seconds /= static_cast<double>(state.iterations());
  state.counters["returning_beams_per_s"] = static_cast<double>(Workload().returns) / seconds;
  state.counters["octomap_beams_per_s"] = static_cast<double>(Workload().returns) / octomap_seconds;
  state.counters["ratio_to_octomap"] = octomap_seconds / seconds;
}
BENCHMARK(MapUpdateBench)->Name("MapUpdate")->Unit(benchmark::kMillisecond);

void InformationGainBench(benchmark::State& state) {
  const VoxelGrid grid = MakeMap(kScansBeforeGain);
  const InformationGain gain(Workload().profiler);
  const GainMap map(grid);
  const octomap::OcTree tree = MakeTree(grid);
  int64_t ours = 0, theirs = 0;
  const double octomap_begin = CpuSeconds();
  for (const ScanPath& path : Workload().paths)
    theirs += CalcGainByOctomap(tree, grid.shape(), Workload().profiler, path);
  const double octomap_seconds = CpuSeconds() - octomap_begin;
  double seconds = 0.0;
  for (auto _ : state) {
    ours = 0;
    const double begin = CpuSeconds();
    for (const ScanPath& path : Workload().paths) ours += gain.Calc(map, path, kAllBeams);
    seconds += CpuSeconds() - begin;
  }
  if (std::abs(ToNats(ours - theirs)) > 0.01 * ToNats(ours)) state.SkipWithError("the gains disagree");
  seconds /= static_cast<double>(state.iterations());
  const auto paths = static_cast<double>(Workload().paths.size());
  state.counters["ms_per_path"] = 1e3 * seconds / paths;
  state.counters["octomap_ms_per_path"] = 1e3 * octomap_seconds / paths;
  state.counters["ratio_to_octomap"] = octomap_seconds / seconds;
}
BENCHMARK(InformationGainBench)->Name("InformationGain")->Unit(benchmark::kMillisecond);

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
