// What the choices of the inverse sensor model bring: SensorModel/0 is the model as it is, each other entry changes one
// thing.

#include <benchmark/benchmark.h>

#include <cmath>

#include "common/runtime/counter_random.h"
#include "services/voxelmap/map_update.h"
#include "tests/bench/voxels_workload.h"

namespace nbs::bench {
namespace {

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

/// A choice of the inverse sensor model.
struct Variant {
  const char* name;
  InverseSensorModelSettings settings;
  double camera_baseline_m = 0.0;
};

std::vector<Variant> MakeVariants() {
  std::vector<Variant> variants(8);
  variants[0].name = "as it is";
  variants[1].name = "k = 0";
  variants[1].settings.free_margin_sigma = 0.0;
  variants[2].name = "k = 6";
  variants[2].settings.free_margin_sigma = 6.0;
  variants[3].name = "occupied cells not spared";
  variants[3].settings.spare_occupied = false;
  variants[4].name = "pass -1 nat";
  variants[4].settings.miss_nat = 1.0;
  variants[5].name = "pass -4 nat";
  variants[5].settings.miss_nat = 4.0;
  variants[6].name = "clamps of OctoMap (0.12, 0.97)";
  variants[6].settings.min_probability = 0.1192;
  variants[6].settings.max_probability = 0.971;
  variants[7].name = "camera at 100 mm";
  variants[7].camera_baseline_m = 0.1;
  return variants;
}

/// Quality, not speed: how closed the surface, how much known to be free, and how little doubt is left where it is,
/// after twenty scans.
void SensorModelBench(benchmark::State& state) {
  const Variant variant = MakeVariants().at(state.range(0));
  const MappingWorkload workload = MakeMappingWorkload(20);
  Profiler profiler = workload.profiler;
  profiler.camera_baseline_m = variant.camera_baseline_m;
  MapUpdate map(workload.shape, profiler, variant.settings);
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
  int64_t free = 0, entropy = 0;
  for (const int16_t log_odds : map.grid().cells()) {
    if (log_odds == kUnobserved || CalcProbability(log_odds) > 0.3) continue;
    ++free;
    entropy += EntropyTable()[static_cast<uint16_t>(log_odds)];
  }
  state.SetLabel(variant.name);
  for (auto _ : state) state.counters["shine_through_percent"] = 100.0 * CalcShineThrough(workload, map.grid());
  state.counters["freed_litres"] = 1e3 * std::pow(workload.shape.resolution_m, 3) * static_cast<double>(free);
  state.counters["entropy_of_a_free_cell_nat"] = static_cast<double>(entropy) / kEntropyPerNat / free;
  state.counters["delta_cells_per_scan"] = static_cast<double>(cells) / 20.0;
  state.counters["delta_runs_per_scan"] = static_cast<double>(runs) / 20.0;
}
BENCHMARK(SensorModelBench)->Name("SensorModel")->DenseRange(0, 7)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
