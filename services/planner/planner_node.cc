#include "services/planner/planner_node.h"

#include <fmt/format.h>

#include <utility>

#include "common/runtime/counter_random.h"
#include "services/planner/boundary_search.h"
#include "services/planner/hole_detection.h"
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

/// Why no candidate was chosen, in words: how many of those that are left met which fate.
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
  return reason.empty() ? std::string(kStackIsEmpty) : reason;
}

}  // namespace

PlannerNode::PlannerNode(const RunConfig& config, Clock clock, const PlannerSettings& settings)
    : config_(config),
      settings_(settings),
      clock_(std::move(clock)),
      next_input_(StreamOf<PlanRequest>()),
      voxels_(config.grid),
      gain_(config.cell.profiler),
      motion_(config),
      selection_(settings.min_gain_nat),
      X_WS_now_(config.first_path.X_WS_start) {}

void PlannerNode::Handle(const Message& message, Outbox& out) {
  if (const auto* request = std::get_if<PlanRequest>(&message)) {
    Answer(*request, out);
  } else if (const auto* mesh = std::get_if<MeshDelta>(&message)) {
    mesh_.Apply(*mesh);
    if (mesh->end_of_scan) next_input_ = StreamOf<VoxelDelta>();
  } else if (const auto* voxels = std::get_if<VoxelDelta>(&message)) {
    voxels_.Apply(*voxels);
    if (voxels->end_of_scan) next_input_ = StreamOf<PlanRequest>();
  }
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
  if (result.found) {
    newest_scan_ = request.scan;
    newest_path_ = result.chosen.candidate.path;
    X_WS_now_ = result.trajectory.points.back().X_WF * config_.cell.X_FS;
    plan.chosen = result.chosen;
    plan.trajectory = std::move(result.trajectory);
    plan.trajectory.utime_us = request.utime_us;
    plan.trajectory.scan = request.scan;
    next_input_ = StreamOf<MeshDelta>();
  } else {
    plan.reason = Explain(result.rated);
  }
  out.push_back(CandidateSet{request.utime_us, request.scan, true, std::move(result.rated)});
  out.push_back(std::move(plan));
  out.push_back(timing);
}

void PlannerNode::AddCandidates(PlanMode mode) {
  std::vector<Candidate> candidates;
  if (mode == PlanMode::kFirst) {
    candidates.push_back({.source = CandidateSource::kFirst, .path = config_.first_path});
  } else if (mode == PlanMode::kBoundary && searched_scan_ != newest_scan_) {
    candidates = FindBoundaryCandidates(BoundarySurface(mesh_), newest_scan_, newest_path_, config_.cell.profiler);
    searched_scan_ = newest_scan_;
  } else if (mode == PlanMode::kHole && !holes_detected_) {
    selection_.Drop(CandidateSource::kBoundary);
    candidates = FindHoleCandidates(BoundarySurface(mesh_), newest_scan_, config_.cell.profiler);
    holes_detected_ = true;
  }
  for (Candidate& candidate : candidates) candidate.id = next_candidate_id_++;
  selection_.Add(candidates);
}

ScanSelection::Result PlannerNode::Select(const PlanRequest& request, PlanTiming& timing) {
  {
    Stopwatch watch(clock_, timing.candidates_s);
    AddCandidates(request.mode);
  }
  const double update_start_s = clock_();
  const MapClearance clearance(voxels_);
  const GainMap gain_map(voxels_, settings_.gain_rule, settings_.gain_reach_m);
  timing.update_s = clock_() - update_start_s;
  return selection_.Select(MakeTools(request, clearance, gain_map, timing));
}

SelectionTools PlannerNode::MakeTools(const PlanRequest& request, const Clearance& clearance, const GainMap& gain_map,
                                      PlanTiming& timing) const {
  SelectionTools tools;
  tools.estimate_gains = [this, &gain_map, &timing](std::span<const ScanPath> paths) {
    Stopwatch watch(clock_, timing.gain_s);
    std::vector<double> gains_nat;
    for (int64_t gain : gain_.CalcAll(gain_map, paths, kSixtyFourth, settings_.gain_threads))
      gains_nat.push_back(ToNats(gain));
    return gains_nat;
  };
  tools.calc_gain = [this, &gain_map, &timing](const ScanPath& path) {
    Stopwatch watch(clock_, timing.gain_s);
    return ToNats(gain_.Calc(gain_map, path, kAllBeams));
  };
  tools.check_path = [this, &clearance, &timing](const ScanPath& path) {
    Stopwatch watch(clock_, timing.motion_s);
    const PathCheck check = motion_.CheckPath(clearance, path);
    return SelectionTools::Check{check.verdict, check.path};
  };
  tools.plan_motion = [this, &request, &clearance, &timing](const ScanPath& path) {
    Stopwatch watch(clock_, timing.motion_s);
    const uint64_t seed = CalcRandomBits({config_.seed, static_cast<uint64_t>(request.scan)});
    MotionPlanner::Result motion = motion_.Plan(clearance, X_WS_now_, path, seed);
    // The path was checked before: a part of it now would be a path without a rating.
    const Verdict verdict = motion.verdict == Verdict::kPartly ? Verdict::kNoMotion : motion.verdict;
    return SelectionTools::Motion{verdict, motion.path, std::move(motion.trajectory)};
  };
  return tools;
}

}  // namespace nbs
