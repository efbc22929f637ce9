#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/planning/scan_path.h"

namespace nbs {

/// What the selection needs to know about scan paths; given as functions so that it can be tested with made-up answers.
struct SelectionTools {
  /// Information gain (eq. 2), nats, of each path, estimated from a part of the beams.
  std::function<std::vector<double>(std::span<const ScanPath>)> estimate_gains;
  /// Information gain, nats, of one path from all its beams.
  std::function<double(const ScanPath&)> calc_gain;
  /// What candidates are ordered by, the higher the better, from the candidate and its gain.
  std::function<double(const Candidate&, double gain_nat)> calc_score = [](const Candidate&, double gain_nat) {
    return gain_nat;
  };

  /// Whether the sensor can run along a path: kReachable, kPartly (then `path` is the longest part that can be reached)
  /// or what blocks it.
  struct Check {
    Verdict verdict = Verdict::kReachable;
    ScanPath path;
  };
  std::function<std::vector<Check>(std::span<const ScanPath>)> check_paths;
  /// At most so many are checked at a time: the one in question and those that come next if it fails. What is found out
  /// about those is not used before they come.
  size_t most_checked = 1;

  /// The motion from where the robot is, over the whole path: kReachable with a trajectory, or kNoMotion.
  struct Motion {
    Verdict verdict = Verdict::kNoMotion;
    ScanPath path;  ///< As driven: the path itself, or reversed.
    Trajectory trajectory;
  };
  std::function<Motion(const ScanPath&)> plan_motion;
};

/// Selection of the next best scan from the stack (sections III-D and III-E): the candidate of highest information gain
/// that the robot can reach.
class ScanSelection {
 public:
  /// Puts candidates on the stack, where they stay over rounds until they are chosen or discarded.
  void Add(std::span<const Candidate> candidates);

  /// Takes the candidates of a source off the stack; the next result names them.
  void Drop(CandidateSource source);

  /// Takes off the stack, unnamed, the candidates for which the next round has better ones.
  void Remove(const std::function<bool(const Candidate&)>& is_obsolete) { std::erase_if(stack_, is_obsolete); }

  size_t stack_size() const { return stack_.size(); }

  struct Result {
    bool found = false;
    RatedCandidate chosen;  ///< Valid when found.
    Trajectory trajectory;  ///< Valid when found.
    std::vector<RatedCandidate>
        rated;  ///< Every candidate of the round, those dropped since the last round first; then by falling gain.
  };

  /// Rates the whole stack and selects.
  ///
  /// All candidates are ranked by the score of the estimated gain; from the top, each is then evaluated with all beams,
  /// checked, and given a motion, until one is left that no other can surpass. A candidate of which only a part can be
  /// reached, or which can be reached with the stripe askew, competes with the gain of that; unless it is chosen it
  /// stays on the stack as it was, because what blocks the rest may turn out free. Ties go to the older candidate. Off
  /// the stack go: the chosen one, and those blocked by an obstacle, outside of the work space, or without gain. Those
  /// blocked by unknown space or without a motion stay.
  ///
  /// @param min_gain_nat  A candidate that promises less is discarded, >= 0.
  Result Select(const SelectionTools& tools, double min_gain_nat);

 private:
  std::vector<Candidate> stack_;
  std::vector<RatedCandidate> dropped_;
};

}  // namespace nbs
