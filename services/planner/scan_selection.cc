#include "services/planner/scan_selection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace nbs {
namespace {

/// How much is known about a candidate in this round.
enum class Stage { kEstimated, kEvaluated, kChecked };

struct Entry {
  RatedCandidate rated;
  double score = 0.0;
  Stage stage = Stage::kEstimated;
  std::optional<SelectionTools::Check> check = {};  ///< Of the whole path, once it is known.
  bool partly = false;
};

/// Order of a heap: the highest score on top, of equals the oldest.
bool IsWorse(const Entry& a, const Entry& b) {
  if (a.score != b.score) return a.score < b.score;
  return a.rated.candidate.id > b.rated.candidate.id;
}

bool StaysOnStack(Verdict verdict) {
  switch (verdict) {
    case Verdict::kReachable:
    case Verdict::kPartly:
    case Verdict::kBlockedByUnknown:
    case Verdict::kNoMotion:
    case Verdict::kNotTried:
      return true;
    default:
      return false;
  }
}

/// True if one path sees otherwise than the other because its stripe lies askew to the other's.
bool IsAskew(const ScanPath& a, const ScanPath& b) {
  constexpr double kSameStripe = 1e-6;
  return std::abs(a.X_WS_start.linear().col(0).dot(b.X_WS_start.linear().col(0))) < 1.0 - kSameStripe;
}

class Heap {
 public:
  void Push(Entry entry) {
    entries_.push_back(std::move(entry));
    std::push_heap(entries_.begin(), entries_.end(), IsWorse);
  }
  Entry Pop() {
    std::pop_heap(entries_.begin(), entries_.end(), IsWorse);
    Entry entry = std::move(entries_.back());
    entries_.pop_back();
    return entry;
  }
  bool empty() const { return entries_.empty(); }
  const Entry& top() const { return entries_.front(); }

 private:
  std::vector<Entry> entries_;
};

/// Checks the path of a candidate, and ahead of time those of the candidates that come next if it fails.
class PathChecker {
 public:
  explicit PathChecker(const SelectionTools& tools) : tools_(tools) {}

  SelectionTools::Check Check(const Entry& entry, Heap& heap) {
    if (entry.check) return *entry.check;
    std::vector<Entry> known;
    std::vector<Entry> next;
    // What lies below a candidate that can be reached hardly ever comes.
    while (!heap.empty() && next.size() + 1 < count_ && heap.top().stage != Stage::kChecked) {
      Entry other = heap.Pop();
      (other.check ? known : next).push_back(std::move(other));
    }
    for (Entry& other : known) heap.Push(std::move(other));
    std::vector<ScanPath> paths = {entry.rated.candidate.path};
    for (const Entry& other : next) paths.push_back(other.rated.candidate.path);
    const std::vector<SelectionTools::Check> checks = tools_.check_paths(paths);
    for (size_t i = 0; i < next.size(); ++i) {
      next[i].check = checks.at(i + 1);
      heap.Push(std::move(next[i]));
    }
    // The first often succeeds; after some failures more are likely.
    count_ = std::min(2 * count_, tools_.most_checked);
    return checks.at(0);
  }

 private:
  const SelectionTools& tools_;
  size_t count_ = 1;
};

/// Takes the top candidate one stage further. True if it is the next best scan; otherwise it is back on the heap or,
/// with its verdict, in `result.rated`.
bool Advance(Entry entry, double min_gain_nat, const SelectionTools& tools, PathChecker& checker, Heap& heap,
             ScanSelection::Result& result) {
  RatedCandidate& rated = entry.rated;
  const auto reject = [&](Verdict verdict) {
    rated.verdict = verdict;
    result.rated.push_back(std::move(rated));
    return false;
  };
  const auto rate = [&] {
    rated.gain_nat = tools.calc_gain(rated.candidate.path);
    entry.score = tools.calc_score(rated.candidate, rated.gain_nat);
  };
  // What is too little of a part may be enough of the whole, once that is free.
  if (rated.gain_nat < min_gain_nat) return reject(entry.partly ? Verdict::kPartly : Verdict::kNoGain);
  if (entry.stage == Stage::kEstimated) {
    rate();
    entry.stage = Stage::kEvaluated;
    heap.Push(std::move(entry));
    return false;
  }
  if (entry.stage == Stage::kEvaluated) {
    const SelectionTools::Check check = checker.Check(entry, heap);
    if (check.verdict != Verdict::kReachable && check.verdict != Verdict::kPartly) return reject(check.verdict);
    entry.stage = Stage::kChecked;
    entry.partly = check.verdict == Verdict::kPartly;
    if (entry.partly || IsAskew(check.path, rated.candidate.path)) {
      rated.candidate.path = check.path;
      rate();
    }
    heap.Push(std::move(entry));
    return false;
  }
  SelectionTools::Motion motion = tools.plan_motion(rated.candidate.path);
  if (motion.verdict != Verdict::kReachable) return reject(motion.verdict);
  rated.verdict = Verdict::kChosen;
  rated.candidate.path = motion.path;
  result.found = true;
  result.chosen = rated;
  result.trajectory = std::move(motion.trajectory);
  result.rated.push_back(std::move(rated));
  return true;
}

}  // namespace

void ScanSelection::Add(std::span<const Candidate> candidates) {
  stack_.insert(stack_.end(), candidates.begin(), candidates.end());
}

void ScanSelection::Drop(CandidateSource source) {
  for (const Candidate& candidate : stack_) {
    if (candidate.source == source) dropped_.push_back({candidate, 0.0, Verdict::kDropped});
  }
  std::erase_if(stack_, [source](const Candidate& candidate) { return candidate.source == source; });
}

ScanSelection::Result ScanSelection::Select(const SelectionTools& tools, double min_gain_nat) {
  Result result;
  result.rated = std::exchange(dropped_, {});
  std::vector<ScanPath> paths;
  paths.reserve(stack_.size());
  for (const Candidate& candidate : stack_) paths.push_back(candidate.path);
  const std::vector<double> gains_nat = tools.estimate_gains(paths);

  Heap heap;
  for (size_t i = 0; i < stack_.size(); ++i)
    heap.Push({{stack_[i], gains_nat.at(i), Verdict::kNotTried}, tools.calc_score(stack_[i], gains_nat[i])});
  PathChecker checker(tools);
  while (!heap.empty() && !result.found) Advance(heap.Pop(), min_gain_nat, tools, checker, heap, result);
  while (!heap.empty()) {
    Entry entry = heap.Pop();
    if (entry.partly) {
      entry.rated.verdict = Verdict::kPartly;
    } else if (entry.rated.gain_nat < min_gain_nat) {
      entry.rated.verdict = Verdict::kNoGain;
    } else if (entry.stage == Stage::kChecked) {
      entry.rated.verdict = Verdict::kReachable;
    }
    result.rated.push_back(std::move(entry.rated));
  }

  std::set<int32_t> gone;
  for (const RatedCandidate& rated : result.rated) {
    if (!StaysOnStack(rated.verdict)) gone.insert(rated.candidate.id);
  }
  std::erase_if(stack_, [&](const Candidate& candidate) { return gone.contains(candidate.id); });
  return result;
}

}  // namespace nbs
