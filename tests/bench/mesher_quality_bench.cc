// What the mesh is worth, side by side with batch meshers on the same points: shapes with known answers, scanned from
// 60 directions. Mesh files named on the command line are scanned too.

#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "tests/bench/mesher_runs.h"
#include "tests/bench/pcl_meshers.h"
#include "tests/services/mesher/mesh_quality.h"
#include "tests/services/mesher/shape_scan.h"
#include "tests/services/mesher/shapes.h"

namespace nbs::bench {
namespace {

/// How a shape is scanned.
struct Scanning {
  std::string shape;
  double noise = 1.0;     ///< Times the profiler's own.
  double offset_m = 0.0;  ///< Of each scan, in a direction of its own.
  double outliers = 0.0;  ///< Share of the ranges.
};

struct Scanned {
  explicit Scanned(const Scanning& scanning)
      : profiler(MakeNoisier({}, scanning.noise)), shape(MakeShapeByName(scanning.shape)) {
    constexpr int kDirections = 60, kSamples = 100'000;
    const TriangleScene scene_W(shape.mesh_W);
    std::vector<Sweep> sweeps = MakeSweepsFromDirections(shape.mesh_W, profiler, kDirections);
    stripes = ScanMesh(scene_W, profiler, sweeps);
    oracle = std::make_unique<QualityOracle>(shape, profiler, stripes, kSamples);
    if (scanning.offset_m > 0.0) {
      DisplaceSweeps(scanning.offset_m, 3, sweeps);
      for (Stripe& stripe : stripes) stripe.X_WS.translation() += sweeps[static_cast<size_t>(stripe.scan)].offset_W;
    }
    if (scanning.outliers > 0.0) AddOutliers(profiler, scanning.outliers, 5, stripes);
    points = CollectPoints(profiler, stripes);
  }

  Profiler profiler;
  Shape shape;
  std::vector<Stripe> stripes;
  std::unique_ptr<QualityOracle> oracle;
  ScannedPoints points;
};

/// The scan of the entry before, if it is the same one.
const Scanned& Scan(const std::string& name, const Scanning& scanning) {
  static std::string last;
  static std::unique_ptr<Scanned> scanned;
  if (name != last) scanned = std::make_unique<Scanned>(scanning);
  last = name;
  return *scanned;
}

PeerMesh MeshByStreaming(const Scanned& scanned) {
  MesherRun run = RunMesher(scanned.profiler, scanned.stripes, true);
  PeerMesh mesh{run.replica.MakeCompactMesh(), 0.0, run.seconds};
  const int64_t heap_bytes = CountHeapBytes();
  run.node.reset();
  mesh.heap_bytes = heap_bytes - CountHeapBytes();
  return mesh;
}

PeerMesh MeshByGreedy(const Scanned& scanned) {
  return MeshByGreedyProjection(scanned.points.p_W, scanned.points.view_W, {});
}

constexpr double kCell_m = 0.003;

PeerMesh MeshByThinnedGreedy(const Scanned& scanned) {
  ScannedPoints points = scanned.points;
  const double begin = CpuSeconds();
  ThinPoints(kCell_m, points.p_W, points.view_W);
  const double thinning = CpuSeconds() - begin;
  PeerSettings settings;
  settings.normal_radius_m = 0.006;
  PeerMesh mesh = MeshByGreedyProjection(points.p_W, points.view_W, settings);
  mesh.seconds += thinning;
  return mesh;
}

PeerMesh MeshByPoisson(const Scanned& scanned) {
  PeerSettings settings;
  settings.normal_radius_m = 0.0015;
  return MeshByPoisson(scanned.points.p_W, scanned.points.view_W, settings, kCell_m);
}

void QualityBench(benchmark::State& state, const std::string& name, const Scanning& scanning,
                  PeerMesh (*make_mesh)(const Scanned&)) {
  const Scanned& scanned = Scan(name, scanning);
  PeerMesh mesh;
  for (auto _ : state) {
    mesh = make_mesh(scanned);
    state.SetIterationTime(mesh.seconds);
  }
  const MeshQuality quality = scanned.oracle->Evaluate(mesh.mesh_W);
  const auto count = [&](const char* counter, int64_t value) { state.counters[counter] = static_cast<double>(value); };
  count("points", static_cast<int64_t>(scanned.points.p_W.size()));
  count("triangles", quality.triangles);
  count("border", quality.border_edges);
  count("border_spurious", quality.spurious_border_edges);
  count("non_manifold", quality.non_manifold_edges + quality.non_manifold_vertices);
  count("flipped", quality.flipped_edges);
  count("degenerate", quality.degenerate_triangles);
  count("joining", quality.joining_triangles);
  state.counters["c_m_%"] = 1e2 * quality.completeness;
  state.counters["covered_%"] = 1e2 * quality.coverage;
  state.counters["measured_%"] = 1e2 * quality.measured;
  state.counters["rms_mm"] = 1e3 * quality.rms_error_m;
  state.counters["worst_mm"] = 1e3 * quality.largest_error_m;
  state.counters["ridge_mm"] = 1e3 * quality.ridge_gap_m;
  state.counters["edge_mm"] = 1e3 * quality.mean_edge_m;
  state.counters["longest_mm"] = 1e3 * quality.longest_edge_m;
  if (mesh.heap_bytes > 0)
    state.counters["bytes_per_vertex"] =
        static_cast<double>(mesh.heap_bytes) / static_cast<double>(mesh.mesh_W.vertices_W.size());
}

void Register(const std::string& name, const Scanning& scanning, bool with_peers) {
  const auto add = [&](const char* mesher, PeerMesh (*make_mesh)(const Scanned&)) {
    benchmark::RegisterBenchmark((name + "/" + mesher).c_str(), QualityBench, name, scanning, make_mesh)
        ->Iterations(1)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("StreamingMesher", MeshByStreaming);
  if (!with_peers) return;
  add("GP3", MeshByGreedy);
  add("GP3_thinned", MeshByThinnedGreedy);
  add("Poisson", MeshByPoisson);
}

void RegisterAll(int file_count, char** files) {
  for (const char* shape : {"sphere", "torus", "cube", "brick", "wedge", "plate", "plates", "cup"})
    Register(shape, {shape}, true);
  for (const char* shape : {"plate", "plates", "cup"}) Register(std::string(shape) + "_noise_x4", {shape, 4.0}, false);
  for (const char* shape : {"sphere", "torus"}) {
    Register(std::string(shape) + "_offset_1mm", {shape, 1.0, 0.001}, false);
    Register(std::string(shape) + "_outliers_1%", {shape, 1.0, 0.0, 0.01}, false);
  }
  Register("statue", {"statue"}, true);
  for (int i = 0; i < file_count; ++i) Register(files[i], {files[i]}, true);
}

}  // namespace
}  // namespace nbs::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  nbs::bench::RegisterAll(argc - 1, argv + 1);
  benchmark::RunSpecifiedBenchmarks();
}
