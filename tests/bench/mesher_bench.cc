// The mesher as a service against PCL's GreedyProjectionTriangulation, which is batch, on the same points and in the
// same run; cost per point, latency of a stripe and memory as the mesh grows.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "tests/bench/mesher_runs.h"
#include "tests/bench/pcl_meshers.h"
#include "tests/services/mesher/shape_scan.h"
#include "tests/services/mesher/shapes.h"

namespace nbs::bench {
namespace {

/// A scanned shape.
struct Workload {
  Profiler profiler;
  std::vector<Stripe> stripes;
};

Workload MakeWorkload(const std::string& name, int directions) {
  const Shape shape = MakeShapeByName(name);
  Workload workload;
  workload.stripes = ScanMesh(TriangleScene(shape.mesh_W), workload.profiler,
                              MakeSweepsFromDirections(shape.mesh_W, workload.profiler, directions));
  return workload;
}

void StreamingMesherBench(benchmark::State& state) {
  constexpr int kDirections = 12;
  const Workload workload = MakeWorkload("statue", kDirections);
  const ScannedPoints points = CollectPoints(workload.profiler, workload.stripes);
  const double peer_seconds = MeshByGreedyProjection(points.p_W, points.view_W, {}).seconds;
  double seconds = 0.0;
  for (auto _ : state) seconds += RunMesher(workload.profiler, workload.stripes, false).seconds;
  seconds /= static_cast<double>(state.iterations());
  const auto count = static_cast<double>(points.p_W.size());
  state.counters["points"] = count;
  state.counters["points_per_second"] = count / seconds;
  state.counters["gp3_points_per_second"] = count / peer_seconds;
  state.counters["ratio_to_gp3"] = peer_seconds / seconds;
}
BENCHMARK(StreamingMesherBench)->Name("StreamingMesher")->Unit(benchmark::kMillisecond)->MinTime(1.0);

/// The mesher in a run over endless hills, whose surface grows with the points.
class GrowingRun {
 public:
  /// What the stripes since the mark before took, and the heap at the mark.
  struct Mark {
    int64_t points = 0, vertices = 0;
    double seconds = 0.0;
    double bytes_per_vertex = 0.0;
    std::vector<double> stripe_seconds;
  };

  /// Goes on until `points` have been folded.
  Mark AdvanceTo(int64_t points) {
    Mark mark;
    Outbox out;
    while (points_ < points) {
      const Message message = MakeHillStripe(profiler_, next_stripe_++);
      const int64_t returns =
          std::ranges::count_if(std::get<Stripe>(message).ranges_m, [](float r) { return r > 0.0f; });
      const double begin = CpuSeconds();
      node_.Handle(message, out);
      mark.stripe_seconds.push_back(CpuSeconds() - begin);
      mark.seconds += mark.stripe_seconds.back();
      points_ += returns;
      mark.points += returns;
      for (const Message& m : out) {
        if (const auto* delta = std::get_if<MeshDelta>(&m)) CountVertices(*delta);
      }
      out.clear();
    }
    mark.vertices = vertices_;
    mark.bytes_per_vertex =
        static_cast<double>(CountHeapBytes() - heap_before_) / static_cast<double>(std::max<int64_t>(vertices_, 1));
    return mark;
  }

 private:
  /// A vertex keeps its number.
  void CountVertices(const MeshDelta& delta) {
    for (const MeshVertex& v : delta.vertices) {
      if (v.id >= seen_.size()) seen_.resize(v.id + 1, false);
      vertices_ += !seen_[v.id];
      seen_[v.id] = true;
    }
  }

  Profiler profiler_;
  int64_t heap_before_ = CountHeapBytes();
  MesherNode node_{RunConfig{}};
  std::vector<bool> seen_;
  int64_t next_stripe_ = 0, points_ = 0, vertices_ = 0;
};

void GrowthBench(benchmark::State& state) {
  static GrowingRun run;
  for (auto _ : state) {
    GrowingRun::Mark mark = run.AdvanceTo(state.range(0));
    if (mark.points == 0) return state.SkipWithError("sizes must ascend");
    state.SetIterationTime(mark.seconds);
    const auto p99 = mark.stripe_seconds.begin() +
                     static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(mark.stripe_seconds.size()));
    std::nth_element(mark.stripe_seconds.begin(), p99, mark.stripe_seconds.end());
    state.counters["us_per_point"] = 1e6 * mark.seconds / static_cast<double>(mark.points);
    state.counters["p99_stripe_ms"] = 1e3 * *p99;
    state.counters["vertices"] = static_cast<double>(mark.vertices);
    state.counters["bytes_per_vertex"] = mark.bytes_per_vertex;
  }
}
BENCHMARK(GrowthBench)
    ->Name("Growth")
    ->Arg(10'000)
    ->Arg(30'000)
    ->Arg(100'000)
    ->Arg(300'000)
    ->Arg(1'000'000)
    ->Arg(3'000'000)
    ->Arg(5'000'000)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
