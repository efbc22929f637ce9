// The selection of the next best scan (candidates, gain after eq. 2, reachability, motion) over a recorded run, as it
// is and with OctoMap's walk in place of ours. The run is that of the default statue, or of the mesh file that the
// environment variable NBS_BENCH_OBJECT names.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "services/planner/candidate_search.h"
#include "services/planner/motion_planning/map_clearance.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "sim/load_object.h"
#include "tests/bench/octomap_peer.h"
#include "tests/whole/whole_run.h"

namespace nbs::bench {
namespace {

constexpr int kMaxScans = 12;
constexpr int kThreads = 2;
constexpr double kMinGain_nat = 20.0;

double WallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// What a planner reads and what it answered.
struct Recording {
  RunConfig config;
  std::vector<PlanRequest> requests;
  std::vector<MeshDelta> meshes;
  std::vector<VoxelDelta> voxels;
  std::vector<Plan> plans;  ///< One per request.
};

Recording MakeRecording() {
  Recording recording;
  RunConfig& config = recording.config;
  config.cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/free.yaml");
  config.gain = ToString(GainRule::kSum);
  config.max_scans = kMaxScans;
  if (const char* file = std::getenv("NBS_BENCH_OBJECT")) {
    config.object = file;
    config.object_file = file;
  }
  const TriangleMesh object_W = LoadObject(config);
  Eigen::AlignedBox3d box_W;
  for (const Eigen::Vector3f& p_W : object_W.vertices_W) box_W.extend(p_W.cast<double>());
  ResolvePlacement(box_W, config);
  (void)RunWhole(config, object_W, {}, nullptr, [&](const Message& message) {
    if (const auto* request = std::get_if<PlanRequest>(&message)) recording.requests.push_back(*request);
    if (const auto* mesh = std::get_if<MeshDelta>(&message)) recording.meshes.push_back(*mesh);
    if (const auto* voxels = std::get_if<VoxelDelta>(&message)) recording.voxels.push_back(*voxels);
    if (const auto* plan = std::get_if<Plan>(&message)) recording.plans.push_back(*plan);
  });
  return recording;
}

const Recording& TheRecording() {
  static const Recording recording = MakeRecording();
  return recording;
}

/// How gains are calculated.
class Walker {
 public:
  virtual ~Walker() = default;
  virtual void Apply(const VoxelDelta& delta) = 0;
  /// What a round begins with.
  virtual void Begin(const VoxelGrid& voxels) = 0;
  virtual std::vector<int64_t> CalcAll(std::span<const ScanPath> paths, GainSampling sampling) const = 0;
};

class OurWalker : public Walker {
 public:
  explicit OurWalker(const RunConfig& config) : gain_(config.cell.profiler) {}
  void Apply(const VoxelDelta&) override {}
  void Begin(const VoxelGrid& voxels) override { map_ = std::make_unique<GainMap>(voxels); }
  std::vector<int64_t> CalcAll(std::span<const ScanPath> paths, GainSampling sampling) const override {
    if (paths.size() == 1) return {gain_.Calc(*map_, paths.front(), sampling, kThreads)};
    return gain_.CalcAll(*map_, paths, sampling, kThreads);
  }

 private:
  InformationGain gain_;
  std::unique_ptr<GainMap> map_;
};

class OctomapWalker : public Walker {
 public:
  explicit OctomapWalker(const RunConfig& config)
      : shape_(config.grid), tree_(MakeTree(VoxelGrid(config.grid))), gain_(tree_, shape_, config.cell.profiler) {}
  void Apply(const VoxelDelta& delta) override { bench::Apply(delta, shape_, tree_); }
  void Begin(const VoxelGrid&) override {}
  std::vector<int64_t> CalcAll(std::span<const ScanPath> paths, GainSampling sampling) const override {
    if (paths.size() == 1) return {gain_.Calc(paths.front(), sampling, kThreads)};
    return gain_.CalcAll(paths, sampling, kThreads);
  }

 private:
  GridShape shape_;
  octomap::OcTree tree_;
  GainByOctomap gain_;
};

/// What one way of selecting took and chose, round by round.
struct Rounds {
  std::vector<double> seconds;
  double gain_seconds = 0.0;
  std::vector<ScanPath> chosen;
  int64_t candidates = 0;
  int64_t in_full = 0;                    ///< Candidates evaluated with all beams.
  std::vector<double> clearance_seconds;  ///< Both distance fields.
};

/// The planner's selection (PlannerNode::Select) round by round.
class Selector {
 public:
  /// @param ranking  Beams by which candidates are ranked; kAllBeams: all are evaluated in full.
  Selector(const RunConfig& config, Walker& walker, GainSampling ranking, int stack_limit)
      : config_(config),
        walker_(walker),
        ranking_(ranking),
        stack_limit_(stack_limit),
        voxels_(config.grid),
        motion_(config),
        prediction_(config.grid),
        searcher_(config, kThreads),
        X_WS_now_(config.first_path.X_WS_start) {}

  void Apply(const MeshDelta& mesh) { mesh_.Apply(mesh); }
  void Apply(const VoxelDelta& voxels) {
    voxels_.Apply(voxels);
    walker_.Apply(voxels);
  }

  void Select(const PlanRequest& request, Rounds& rounds) {
    const double begin = WallSeconds();
    const MapClearance clearance(voxels_);
    rounds.clearance_seconds.push_back(WallSeconds() - begin);
    walker_.Begin(voxels_);
    searcher_.Update(request.mode, {mesh_, voxels_, prediction_, newest_scan_, newest_path_, {}}, selection_);
    Thin();
    rounds.candidates += static_cast<int64_t>(selection_.stack_size());
    const double min_gain_nat = request.mode == PlanMode::kFirst ? 0.0 : kMinGain_nat;
    const ScanSelection::Result result =
        selection_.Select(MakeTools(clearance, static_cast<uint64_t>(request.scan), rounds), min_gain_nat);
    rounds.seconds.push_back(WallSeconds() - begin);
    rounds.chosen.push_back(result.chosen.candidate.path);
  }

  /// The run went on like this.
  void GoOn(const Plan& plan) {
    if (!plan.found) return;
    newest_scan_ = plan.scan;
    newest_path_ = plan.chosen.candidate.path;
    X_WS_now_ = plan.trajectory.points.back().X_WF * config_.cell.X_FS;
  }

 private:
  /// Leaves at most `stack_limit` candidates on the stack, evenly chosen.
  void Thin() {
    const auto size = static_cast<int64_t>(selection_.stack_size()), limit = int64_t{stack_limit_};
    int64_t k = 0;
    selection_.Remove([&](const Candidate&) {
      const int64_t i = k++;
      return size > limit && i * limit / size == (i + 1) * limit / size;
    });
  }

  SelectionTools MakeTools(const Clearance& clearance, uint64_t seed, Rounds& rounds) const {
    SelectionTools tools;
    tools.estimate_gains = [this, &rounds](std::span<const ScanPath> paths) {
      const double begin = WallSeconds();
      std::vector<double> gains_nat;
      for (const int64_t gain : walker_.CalcAll(paths, ranking_)) gains_nat.push_back(ToNats(gain));
      rounds.gain_seconds += WallSeconds() - begin;
      return gains_nat;
    };
    tools.calc_gain = [this, &rounds](const ScanPath& path) {
      const double begin = WallSeconds();
      const double gain_nat = ToNats(walker_.CalcAll({&path, 1}, kAllBeams).front());
      rounds.gain_seconds += WallSeconds() - begin;
      ++rounds.in_full;
      return gain_nat;
    };
    tools.check_paths = [this, &clearance](std::span<const ScanPath> paths) {
      std::vector<SelectionTools::Check> checks;
      for (const PathCheck& check : motion_.CheckPaths(clearance, paths, kThreads))
        checks.push_back({check.verdict, check.path});
      return checks;
    };
    tools.plan_motion = [this, &clearance, seed](const ScanPath& path) {
      MotionPlanner::Result motion = motion_.Plan(clearance, X_WS_now_, path, seed);
      const Verdict verdict = motion.verdict == Verdict::kPartly ? Verdict::kNoMotion : motion.verdict;
      return SelectionTools::Motion{verdict, motion.path, std::move(motion.trajectory)};
    };
    return tools;
  }

  const RunConfig& config_;
  Walker& walker_;
  GainSampling ranking_;
  int stack_limit_;
  MeshReplica mesh_;
  VoxelGrid voxels_;
  MotionPlanner motion_;
  SurfacePrediction prediction_;
  CandidateSearcher searcher_;
  ScanSelection selection_;
  int32_t newest_scan_ = -1;
  ScanPath newest_path_;
  Pose X_WS_now_;
};

/// Selects in every round of the recording.
Rounds RunSelections(Walker& walker, GainSampling ranking, int stack_limit) {
  const Recording& recording = TheRecording();
  Selector selector(recording.config, walker, ranking, stack_limit);
  Rounds rounds;
  auto mesh = recording.meshes.begin();
  auto voxels = recording.voxels.begin();
  for (size_t i = 0; i < recording.requests.size(); ++i) {
    const PlanRequest& request = recording.requests[i];
    for (; mesh != recording.meshes.end() && mesh->scan < request.scan; ++mesh) selector.Apply(*mesh);
    for (; voxels != recording.voxels.end() && voxels->scan < request.scan; ++voxels) selector.Apply(*voxels);
    selector.Select(request, rounds);
    selector.GoOn(recording.plans.at(i));
  }
  return rounds;
}

double Sum(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

bool AreSame(const ScanPath& a, const ScanPath& b) {
  return a.X_WS_start.isApprox(b.X_WS_start) && a.X_WS_end.isApprox(b.X_WS_end);
}

int64_t CountSame(const Rounds& a, const Rounds& b) {
  int64_t same = 0;
  for (size_t i = 0; i < a.chosen.size(); ++i) same += AreSame(a.chosen[i], b.chosen[i]) ? 1 : 0;
  return same;
}

double FindQuantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5));
}

void Report(benchmark::State& state, const Rounds& rounds) {
  const auto count = static_cast<double>(rounds.seconds.size());
  state.counters["rounds"] = count;
  state.counters["candidates_a_round"] = static_cast<double>(rounds.candidates) / count;
  state.counters["in_full_a_round"] = static_cast<double>(rounds.in_full) / count;
  state.counters["mean_s"] = Sum(rounds.seconds) / count;
  state.counters["p95_s"] = FindQuantile(rounds.seconds, 0.95);
  state.counters["gain_mean_s"] = rounds.gain_seconds / count;
  state.counters["fields_median_s"] = FindQuantile(rounds.clearance_seconds, 0.5);
}

/// Selects as the planner does from a stack of at most `state.range(0)` candidates; then with every beam of every
/// candidate, and then with OctoMap's walk in place of ours.
void SelectionBench(benchmark::State& state) {
  const RunConfig& config = TheRecording().config;
  const int limit = static_cast<int>(state.range(0));
  Rounds ours;
  for (auto _ : state) {
    OurWalker walker(config);
    ours = RunSelections(walker, kSixtyFourth, limit);
  }
  OurWalker full_walker(config);
  const Rounds in_full = RunSelections(full_walker, kAllBeams, limit);
  OctomapWalker octomap_walker(config);
  const Rounds octomap = RunSelections(octomap_walker, kSixtyFourth, limit);
  const auto count = static_cast<double>(ours.seconds.size());
  Report(state, ours);
  state.counters["same_choice_as_in_full"] = static_cast<double>(CountSame(ours, in_full));
  state.counters["same_choice_as_octomap"] = static_cast<double>(CountSame(ours, octomap));
  state.counters["in_full_mean_s"] = Sum(in_full.seconds) / count;
  state.counters["octomap_mean_s"] = Sum(octomap.seconds) / count;
  state.counters["ratio_to_octomap"] = Sum(octomap.seconds) / Sum(ours.seconds);
}
// The second takes minutes: OctoMap walks through thousands of candidates.
BENCHMARK(SelectionBench)->Name("Selection")->Arg(100)->Arg(100000)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
