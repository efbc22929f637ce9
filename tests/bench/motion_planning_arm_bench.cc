// Motions of the arm in a recorded run of the cell kr16: how long selections and motion plans take, and RRT-Connect
// beside PRM on the same requests. The run is that of the default statue, or of the mesh file that the environment
// variable NBS_BENCH_OBJECT names.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "common/kinematics/urdf_reader.h"
#include "services/planner/motion_planning/arm_reach.h"
#include "services/planner/motion_planning/joint_search.h"
#include "services/planner/motion_planning/map_clearance.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "sim/load_object.h"
#include "tests/whole/whole_run.h"

namespace nbs::bench {
namespace {

constexpr int kMaxScans = 12;
constexpr size_t kRequestsARound = 15;

double Seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double FindQuantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values.at(static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5));
}

/// A motion that was asked for, or could have been: to a path that can be driven.
struct Request {
  size_t round = 0;
  RobotPosture now;
  ScanPath path;
  uint64_t seed = 0;
};

struct Recording {
  RunConfig config;
  std::vector<VoxelGrid> voxels;  ///< By round.
  std::vector<Request> requests;
  std::vector<PlanTiming> timings;
};

/// Puts together what the planner read and answered.
class Recorder {
 public:
  Recorder(Recording& recording, const RobotPosture& start)
      : recording_(recording), voxels_(recording.config.grid), now_(start) {}

  void operator()(const Message& message) {
    if (const auto* delta = std::get_if<VoxelDelta>(&message)) voxels_.Apply(*delta);
    if (const auto* set = std::get_if<CandidateSet>(&message)) Add(*set);
    if (const auto* timing = std::get_if<PlanTiming>(&message)) recording_.timings.push_back(*timing);
    if (const auto* plan = std::get_if<Plan>(&message); plan != nullptr && plan->found) {
      const TrajectoryPoint& last = plan->trajectory.points.back();
      now_ = {last.X_WF * recording_.config.cell.X_FS, last.joints_rad};
    }
  }

 private:
  void Add(const CandidateSet& set) {
    std::vector<const RatedCandidate*> drivable;
    for (const RatedCandidate& rated : set.candidates) {
      const Verdict verdict = rated.verdict;
      if (verdict == Verdict::kChosen || verdict == Verdict::kReachable || verdict == Verdict::kPartly ||
          verdict == Verdict::kNoMotion)
        drivable.push_back(&rated);
    }
    recording_.voxels.push_back(voxels_);
    const size_t step = std::max<size_t>(1, drivable.size() / kRequestsARound);
    for (size_t i = 0; i < drivable.size(); i += step) {
      recording_.requests.push_back({recording_.voxels.size() - 1, now_, drivable[i]->candidate.path,
                                     static_cast<uint64_t>(recording_.requests.size())});
    }
  }

  Recording& recording_;
  VoxelGrid voxels_;
  RobotPosture now_;
};

const Recording& TheRecording() {
  static const Recording recording = [] {
    Recording made;
    RunConfig& config = made.config;
    config.cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/kr16.yaml");
    config.max_scans = kMaxScans;
    config.completeness = 0.999;
    if (const char* file = std::getenv("NBS_BENCH_OBJECT")) config.object = config.object_file = file;
    const TriangleMesh object_W = LoadObject(config);
    Eigen::AlignedBox3d box_W;
    for (const Eigen::Vector3f& p_W : object_W.vertices_W) box_W.extend(p_W.cast<double>());
    ResolvePlacement(box_W, config);
    Recorder recorder(made, MotionPlanner(config).MakeStartPosture(config.first_path));
    (void)RunWhole(config, object_W, {}, nullptr, std::ref(recorder));
    return made;
  }();
  return recording;
}

void BM_Selection(benchmark::State& state) {
  std::vector<double> seconds;
  std::vector<double> motion_s;
  std::vector<double> plans_ms;
  for (auto _ : state) {
    for (const PlanTiming& timing : TheRecording().timings) {
      if (timing.scan == 0) continue;
      seconds.push_back(timing.total_s);
      motion_s.push_back(timing.motion_s);
      for (const double plan_s : timing.plans_s) plans_ms.push_back(1e3 * plan_s);
    }
  }
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  state.counters["rounds"] = static_cast<double>(seconds.size());
  state.counters["mean_s"] = mean(seconds);
  state.counters["p95_s"] = FindQuantile(seconds, 0.95);
  state.counters["motion_mean_s"] = mean(motion_s);
  state.counters["plans"] = static_cast<double>(plans_ms.size());
  state.counters["plan_median_ms"] = FindQuantile(plans_ms, 0.5);
  state.counters["plan_p95_ms"] = FindQuantile(plans_ms, 0.95);
}
BENCHMARK(BM_Selection)->Unit(benchmark::kMillisecond)->Iterations(1);

/// The requests of the recording, one after the other.
template <typename Answer>
void AnswerRequests(const Answer& answer) {
  const Recording& recording = TheRecording();
  for (size_t round = 0; round < recording.voxels.size(); ++round) {
    const MapClearance clearance(recording.voxels[round]);
    for (const Request& request : recording.requests) {
      if (request.round == round) answer(clearance, request);
    }
  }
}

void BM_MotionPlan(benchmark::State& state) {
  const MotionPlanner planner(TheRecording().config);
  std::vector<double> plans_ms;
  int64_t found = 0;
  for (auto _ : state) {
    AnswerRequests([&](const Clearance& clearance, const Request& request) {
      const double begin_s = Seconds();
      found += planner.Plan(clearance, request.now, request.path, request.seed).found() ? 1 : 0;
      plans_ms.push_back(1e3 * (Seconds() - begin_s));
    });
  }
  state.counters["requests"] = static_cast<double>(plans_ms.size());
  state.counters["found"] = static_cast<double>(found);
  state.counters["median_ms"] = FindQuantile(plans_ms, 0.5);
  state.counters["p95_ms"] = FindQuantile(plans_ms, 0.95);
  state.counters["max_ms"] = FindQuantile(plans_ms, 1.0);
}
BENCHMARK(BM_MotionPlan)->Unit(benchmark::kMillisecond)->Iterations(1);

/// The search of those requests that no straight line in joint space answers, with so many extensions or milestones.
void BM_Search(benchmark::State& state, SearchAlgorithm algorithm) {
  const RunConfig& config = TheRecording().config;
  const ArmModel model = ReadArm(config.cell.arm->urdf, config.cell.arm->base_link, config.cell.arm->flange_link);
  const ArmSetup arm{InverseKinematics(model, IkMethod::kAnalytic), ArmCollision(config, model), config.cell.X_FS,
                     config.cell.profiler.scan_speed_m_per_s};
  std::vector<double> search_ms;
  int64_t found = 0;
  double length_rad = 0.0;
  const auto answer = [&](const Clearance& clearance, const Request& request) {
    const Joints q_now = Eigen::Map<const Eigen::VectorXd>(request.now.joints_rad.data(), model.n());
    if (!arm.collision.IsFree(clearance, q_now)) return;
    std::vector<Joints> goals;
    for (const ArmDrive& drive : FindArmReach(arm, clearance, request.path).drives) {
      if (arm.collision.IsFreeMotion(clearance, q_now, drive.q.front())) return;
      if (goals.size() < 8) goals.push_back(drive.q.front());
    }
    if (goals.empty()) return;
    JointSearchSettings settings;
    settings.iterations = static_cast<int>(state.range(0));
    settings.seed = request.seed;
    settings.algorithm = algorithm;
    settings.shortcuts = MotionSettings{}.shortcuts;
    const int sensor = static_cast<int>(arm.collision.body().parts().size()) - 1;
    for (int k = 0; k < model.n(); ++k) settings.metres_per_rad.push_back(arm.collision.body().CalcReach(sensor, k));
    const JointCheck is_free = [&](const Joints& q) { return arm.collision.IsFree(clearance, q); };
    const JointMotionCheck is_free_motion = [&](const Joints& from, const Joints& to) {
      return arm.collision.IsFreeMotion(clearance, from, to);
    };
    const double begin_s = Seconds();
    const JointWay way = FindJointWay(model, q_now, goals, settings, is_free, is_free_motion);
    search_ms.push_back(1e3 * (Seconds() - begin_s));
    if (way.q.empty()) return;
    ++found;
    for (size_t k = 0; k + 1 < way.q.size(); ++k) length_rad += (way.q[k + 1] - way.q[k]).norm();
  };
  for (auto _ : state) AnswerRequests(answer);
  state.counters["requests"] = static_cast<double>(search_ms.size());
  state.counters["found"] = static_cast<double>(found);
  state.counters["mean_length_rad"] = found > 0 ? length_rad / static_cast<double>(found) : 0.0;
  state.counters["median_ms"] = FindQuantile(search_ms, 0.5);
  state.counters["p95_ms"] = FindQuantile(search_ms, 0.95);
}
BENCHMARK_CAPTURE(BM_Search, rrt_connect, SearchAlgorithm::kRrtConnect)
    ->Arg(300)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(BM_Search, prm, SearchAlgorithm::kPrm)
    ->Arg(300)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
