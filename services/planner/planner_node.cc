#include "services/planner/planner_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/runtime/apply_if_sound.h"
#include "common/runtime/counter_random.h"
#include "services/planner/motion_planning/map_clearance.h"

namespace nbs {
namespace {

/// Adds the wall-clock time from construction to destruction to a sum.
class Stopwatch {
 public:
  Stopwatch(const PlannerNode::Clock& clock, double& sum_s) : clock_(clock), sum_s_(sum_s), start_s_(clock()) {}
  ~Stopwatch() { sum_s_ += clock_() - start_s_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  const PlannerNode::Clock& clock_;
  double& sum_s_;
  double start_s_;
};

/// Why no candidate was chosen, in words: how many of those that are left met which fate; empty if none is left.
std::string Explain(const std::vector<RatedCandidate>& rated) {
  std::array<int, kVerdicts> counts{};
  for (const RatedCandidate& candidate : rated) ++counts.at(static_cast<size_t>(candidate.verdict));
  counts[static_cast<size_t>(Verdict::kDropped)] = 0;
  counts[static_cast<size_t>(Verdict::kNoGain)] = 0;
  std::string reason;
  for (int v = 0; v < kVerdicts; ++v) {
    if (counts[v] == 0) continue;
    reason += fmt::format("{}{} {}", reason.empty() ? "" : ", ", counts[v], ToString(static_cast<Verdict>(v)));
  }
  return reason;
}

}  // namespace

PlannerNode::PlannerNode(const RunConfig& config, Clock clock, const PlannerSettings& settings)
    : config_(config),
      settings_(settings),
      clock_(std::move(clock)),
      next_input_(StreamOf<PlanRequest>()),
      voxels_(config.grid),
      method_(FindMethod(config.method)),
      rating_{FindGainRule(config.gain).value(),
              method_.by_gain,
              settings.gain_reach_m,
              settings.ranking,
              settings.threads,
              config.cell},
      motion_(config),
      prediction_(config.grid),
      searcher_(config, settings.threads),
      now_(motion_.MakeStartPosture(config.first_path)) {
  motion_.CheckStart(MapClearance(voxels_), config.first_path);
}

void PlannerNode::Handle(const Message& message, Outbox& out) {
  if (const auto* request = std::get_if<PlanRequest>(&message)) {
    Answer(*request, out);
  } else if (const auto* mesh = std::get_if<MeshDelta>(&message)) {
    refused_mesh_ += ApplyIfSound(*mesh, mesh_) ? 0 : 1;
    if (mesh->end_of_scan) next_input_ = StreamOf<VoxelDelta>();
  } else if (const auto* voxels = std::get_if<VoxelDelta>(&message)) {
    refused_voxels_ += ApplyIfSound(*voxels, voxels_) ? 0 : 1;
    if (voxels->end_of_scan) next_input_ = StreamOf<PlanRequest>();
  }
}

std::vector<Node::Count> PlannerNode::Complaints() const {
  return {{"refused_mesh", refused_mesh_}, {"refused_voxels", refused_voxels_}};
}

void PlannerNode::Answer(const PlanRequest& request, Outbox& out) {
  PlanTiming timing;
  timing.utime_us = request.utime_us;
  timing.scan = request.scan;
  ScanSelection::Result result;
  {
    Stopwatch total(clock_, timing.total_s);
    result = Select(request, timing);
  }
  Plan plan;
  plan.utime_us = request.utime_us;
  plan.scan = request.scan;
  plan.mode = request.mode;
  plan.found = result.found;
  plan.unknown_cells = std::ranges::count(voxels_.cells(), kUnobserved);
  if (result.found) {
    newest_scan_ = request.scan;
    newest_path_ = result.chosen.candidate.path;
    const TrajectoryPoint& last = result.trajectory.points.back();
    now_ = {last.X_WF * config_.cell.X_FS, last.joints_rad};
    plan.chosen = result.chosen;
    plan.trajectory = std::move(result.trajectory);
    plan.trajectory.utime_us = request.utime_us;
    plan.trajectory.scan = request.scan;
    next_input_ = StreamOf<MeshDelta>();
  } else {
    plan.reason = Explain(result.rated);
    plan.stack_is_empty = plan.reason.empty();
    if (plan.stack_is_empty) plan.reason = "the stack is empty";
  }
  out.push_back(CandidateSet{request.utime_us, request.scan, true, std::move(result.rated)});
  out.push_back(std::move(plan));
  out.push_back(timing);
}

void PlannerNode::FoldNewestScan() {
  if (!rating_.by_gain || rating_.rule != GainRule::kSurface) return;
  if (std::exchange(predicted_scan_, newest_scan_) == newest_scan_) return;
  prediction_.AddScan(voxels_, config_.cell.profiler, newest_path_);
  prediction_.Update(voxels_, mesh_, settings_.threads);
}

double PlannerNode::FindMinGain(PlanMode mode) const {
  if (mode == PlanMode::kFirst || !method_.by_gain) return 0.0;
  return mode == PlanMode::kHole ? settings_.min_hole_gain_nat : settings_.min_gain_nat;
}

ScanSelection::Result PlannerNode::Select(const PlanRequest& request, PlanTiming& timing) {
  const double update_start_s = clock_();
  FoldNewestScan();
  std::unique_ptr<const Clearance> clearance;
  if (method_.collision_test) {
    clearance = std::make_unique<MapClearance>(voxels_);
  } else {
    clearance = std::make_unique<NothingSolid>();
  }
  const CandidateRating rating(rating_, voxels_, prediction_);
  timing.update_s = clock_() - update_start_s;
  {
    Stopwatch watch(clock_, timing.candidates_s);
    const auto could_drive = [this, &clearance](const ScanPath& path) { return motion_.CouldDrive(*clearance, path); };
    searcher_.Update(request.mode,
                     {mesh_, voxels_, prediction_, newest_scan_, newest_path_,
                      method_.collision_test ? could_drive : std::function<bool(const ScanPath&)>()},
                     selection_);
  }
  return selection_.Select(MakeTools(request, *clearance, rating, timing), FindMinGain(request.mode));
}

SelectionTools PlannerNode::MakeTools(const PlanRequest& request, const Clearance& clearance,
                                      const CandidateRating& rating, PlanTiming& timing) const {
  SelectionTools tools;
  tools.estimate_gains = [this, &rating, &timing](std::span<const ScanPath> paths) {
    Stopwatch watch(clock_, timing.gain_s);
    return rating.EstimateGains(paths);
  };
  tools.calc_gain = [this, &rating, &timing](const ScanPath& path) {
    Stopwatch watch(clock_, timing.gain_s);
    return rating.CalcGain(path);
  };
  tools.calc_score = [this, &rating](const Candidate& candidate, double gain_nat) {
    return rating.CalcScore(candidate, gain_nat, now_.X_WS);
  };
  tools.check_paths = [this, &clearance, &timing](std::span<const ScanPath> paths) {
    Stopwatch watch(clock_, timing.motion_s);
    std::vector<SelectionTools::Check> checks;
    for (const PathCheck& check : motion_.CheckPaths(clearance, paths, settings_.threads))
      checks.push_back({check.verdict, check.path});
    return checks;
  };
  if (motion_.ChecksSlowly()) tools.most_checked = size_t{8} * static_cast<size_t>(settings_.threads);
  tools.plan_motion = [this, &request, &clearance, &timing](const ScanPath& path) {
    Stopwatch watch(clock_, timing.motion_s);
    Stopwatch plan_watch(clock_, timing.plans_s.emplace_back(0.0));
    const uint64_t seed = CalcRandomBits({config_.seed, static_cast<uint64_t>(request.scan)});
    MotionPlanner::Result motion = motion_.Plan(clearance, now_, path, seed);
    // The path was checked before: a part of it now would be a path without a rating.
    const Verdict verdict = motion.verdict == Verdict::kPartly ? Verdict::kNoMotion : motion.verdict;
    return SelectionTools::Motion{verdict, motion.path, std::move(motion.trajectory)};
  };
  return tools;
}

}  // namespace nbs
