#include "services/reporter/reporter_node.h"

#include <fmt/ostream.h>

#include <utility>

#include "common/runtime/apply_if_sound.h"

namespace nbs {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

void PrintHeader(std::ostream& out) {
  fmt::print(out, "{:>4}  {:<8}  {:>9}  {:>7}  {:>9}  {:>12}  {:>8}  {:>10}  {:>9}\n", "scan", "source", "gain", "path",
             "select", "completeness", "coverage", "candidates", "triangles");
}

void PrintScan(const ScanRecord& scan, std::ostream& out) {
  const std::string coverage = scan.evaluation ? fmt::format("{:.2f} %", 100.0 * scan.evaluation->coverage) : "-";
  const std::string gain = scan.by_gain() ? fmt::format("{:.0f} nat", scan.gain_nat) : "-";
  fmt::print(out, "{:>4}  {:<8}  {:>9}  {:>5.2f} m  {:>6.0f} ms  {:>10.2f} %  {:>8}  {:>10}  {:>9}\n", scan.scan + 1,
             ToString(scan.source), gain, scan.path.length_m(), 1e3 * scan.timing.total_s, 100.0 * scan.completeness,
             coverage, scan.candidates, scan.triangles);
  out.flush();
}

}  // namespace

ReporterNode::ReporterNode(const GridShape& grid, Evaluator evaluator, std::ostream* progress, Observer observer)
    : evaluator_(std::move(evaluator)),
      observer_(std::move(observer)),
      progress_(progress),
      next_input_(StreamOf<RunState>()),
      voxels_(grid) {}

void ReporterNode::Handle(const Message& message, Outbox&) {
  std::visit(
      Overloaded{[this](const RunState& m) { Fold(m); }, [this](const CandidateSet& m) { Fold(m); },
                 [this](const Plan& m) { Fold(m); }, [this](const PlanTiming& m) { Fold(m); },
                 [this](const Execution& m) { Fold(m); }, [this](const MeshDelta& m) { Fold(m); },
                 [this](const VoxelDelta& m) { Fold(m); }, [this](const MeshScan& m) { Fold(m); }, [](const auto&) {}},
      message);
}

std::vector<Node::Count> ReporterNode::Complaints() const {
  return {{"refused_mesh", refused_mesh_}, {"refused_voxels", refused_voxels_}};
}

void ReporterNode::Fold(const RunState& state) {
  switch (state.phase) {
    case RunPhase::kPlanning:
      next_input_ = StreamOf<CandidateSet>();
      break;
    case RunPhase::kScanning:
      next_input_ = StreamOf<Execution>();
      break;
    case RunPhase::kFinished:
      record_.end_reason = state.end_reason;
      record_.detail = state.detail;
      record_.failed = state.failed;
      record_.last_verdicts = current_.verdicts;
      record_.last_timing = current_.timing;
      next_input_ = kNoInput;
      break;
  }
}

void ReporterNode::Fold(const CandidateSet& set) {
  for (const RatedCandidate& rated : set.candidates) ++current_.verdicts.at(static_cast<size_t>(rated.verdict));
  current_.candidates += static_cast<int>(set.candidates.size());
  if (set.end) next_input_ = StreamOf<Plan>();
}

void ReporterNode::Fold(const Plan& plan) {
  current_.mode = plan.mode;
  if (plan.found) {
    current_.source = plan.chosen.candidate.source;
    current_.path = plan.chosen.candidate.path;
    current_.gain_nat = plan.chosen.gain_nat;
  }
  next_input_ = StreamOf<PlanTiming>();
}

void ReporterNode::Fold(const PlanTiming& timing) {
  // A round that found nothing and the round in the other mode after it are one selection.
  current_.timing.update_s += timing.update_s;
  current_.timing.candidates_s += timing.candidates_s;
  current_.timing.gain_s += timing.gain_s;
  current_.timing.motion_s += timing.motion_s;
  current_.timing.total_s += timing.total_s;
  current_.timing.plans_s.insert(current_.timing.plans_s.end(), timing.plans_s.begin(), timing.plans_s.end());
  next_input_ = StreamOf<RunState>();
}

void ReporterNode::Fold(const Execution& execution) {
  current_.scan = execution.scan;
  current_.scanned_utime_us = execution.utime_us;
  next_input_ = StreamOf<MeshDelta>();
}

void ReporterNode::Fold(const MeshDelta& delta) {
  refused_mesh_ += ApplyIfSound(delta, mesh_) ? 0 : 1;
  if (delta.end_of_scan) next_input_ = StreamOf<VoxelDelta>();
}

void ReporterNode::Fold(const VoxelDelta& delta) {
  refused_voxels_ += ApplyIfSound(delta, voxels_) ? 0 : 1;
  if (delta.end_of_scan) next_input_ = StreamOf<MeshScan>();
}

void ReporterNode::Fold(const MeshScan& figures) {
  current_.stripes = figures.stripes;
  current_.points = figures.points;
  current_.completeness = figures.completeness;
  current_.rim_length_m = figures.rim_length_m;
  current_.triangles = figures.triangles;
  current_.edges = figures.edges;
  record_.refused_measurements = figures.refused;
  if (evaluator_ || observer_) {
    const TriangleMesh mesh_W = mesh_.MakeCompactMesh();
    if (evaluator_) current_.evaluation = evaluator_(mesh_W);
    if (observer_) observer_(mesh_W);
  }
  if (progress_ != nullptr) {
    if (record_.scans.empty()) PrintHeader(*progress_);
    PrintScan(current_, *progress_);
  }
  record_.scans.push_back(std::exchange(current_, {}));
  next_input_ = StreamOf<RunState>();
}

}  // namespace nbs
