#include "services/planner/motion_planning/arm_reach.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "services/planner/motion_planning/flange_path.h"

namespace nbs {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kSameLength_m = 1e-3;

/// The sensor turned about its viewing axis all along the path.
ScanPath TurnPath(const ScanPath& path, double angle_rad) {
  if (angle_rad == 0.0) return path;
  const Eigen::AngleAxisd turn(angle_rad, Eigen::Vector3d::UnitZ());
  return {path.X_WS_start * turn, path.X_WS_end * turn};
}

/// How near to success a verdict is; the higher the nearer.
int RankOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoInverseKinematics:
      return 0;
    case Verdict::kJointLimit:
      return 1;
    case Verdict::kSpeed:
      return 2;
    case Verdict::kSelfCollision:
      return 3;
    case Verdict::kBlockedByObstacle:
      return 4;
    default:
      return 5;
  }
}

/// A stretch of a chain: numbers of its first and its last state.
struct Stretch {
  size_t first = 0;
  size_t last = 0;

  size_t length() const { return last - first; }
};

/// The longest stretch of a chain along which the arm is free between its states as well.
Stretch FindFreeStretch(const ArmSetup& arm, const Clearance& clearance, const JointChain& chain) {
  Stretch best;
  size_t first = 0;
  for (size_t k = 1; k <= chain.q.size(); ++k) {
    if (k < chain.q.size() && arm.collision.IsFreeMotion(clearance, chain.q[k - 1], chain.q[k])) continue;
    if (k - 1 - first > best.length()) best = {first, k - 1};
    first = k;
  }
  return best;
}

/// True if two chains over the same poses differ by whole turns of joints alone: the arm is in the same places.
bool AreTurned(const JointChain& a, const JointChain& b) {
  constexpr double kSame_rad = 1e-6;
  const auto off = [](double d) { return std::abs(std::remainder(d, 2.0 * std::numbers::pi)); };
  return a.begin == b.begin && (a.q.front() - b.q.front()).unaryExpr(off).maxCoeff() < kSame_rad &&
         (a.q.back() - b.q.back()).unaryExpr(off).maxCoeff() < kSame_rad;
}

/// The free stretches of chains, looked for once for chains that differ by whole turns.
class Stretches {
 public:
  Stretches(const ArmSetup& arm, const Clearance& clearance, const std::vector<JointChain>& chains)
      : arm_(arm), clearance_(clearance), chains_(chains) {}

  /// Of the next chain.
  const Stretch& FindNext() {
    const size_t k = found_.size();
    size_t same = 0;
    while (same < k && !AreTurned(chains_[same], chains_[k])) ++same;
    found_.push_back(same < k ? Stretch(found_[same]) : FindFreeStretch(arm_, clearance_, chains_[k]));
    return found_.back();
  }

 private:
  const ArmSetup& arm_;
  const Clearance& clearance_;
  const std::vector<JointChain>& chains_;
  std::vector<Stretch> found_;
};

/// Lengths that differ by less than a millimetre count as one.
int64_t CountMillimetres(const ScanPath& path) { return std::llround(path.length_m() / kSameLength_m); }

/// What is asked of a roll.
struct Wanted {
  double part_m = 0.0;  ///< Shorter parts do not count.
  size_t drives = 1;    ///< At most so many ways to drive what can be driven.
};

/// What a roll allows; where it allows nothing, the ladder knows why.
struct RollReach {
  bool whole = false;
  std::vector<ArmDrive> drives;
  std::optional<JointLadder> ladder;
  int wanted = 0;  ///< Poses of the ladder.

  Verdict FindReason() { return ladder ? ladder->FindReason(wanted) : Verdict::kBlockedByUnknown; }
};

/// Looks for chains along a part and takes up those that are free all along. If none is, cuts the part to the longest
/// free stretch; false if there is none of the wanted length.
bool FollowPart(const ArmSetup& arm, const Clearance& clearance, const ArmReachSettings& settings, const Wanted& wanted,
                ScanPath& part, RollReach& reach) {
  const std::vector<Pose> line_WF = MakeLine(arm.X_FS, part, settings.chain);
  const int steps = static_cast<int>(line_WF.size()) - 1;
  const double step_m = part.length_m() / steps;
  reach.wanted = step_m > 0.0 && wanted.part_m > 0.0
                     ? std::min(steps, static_cast<int>(std::ceil(wanted.part_m / step_m))) + 1
                     : steps + 1;
  reach.ladder.emplace(arm.ik, arm.collision, clearance, line_WF, step_m / arm.scan_m_per_s, settings.chain);
  const std::vector<JointChain> chains = reach.ladder->FindChains(reach.wanted);
  if (chains.empty()) return false;
  Stretches stretches(arm, clearance, chains);
  Stretch longest;
  int begin = 0;
  for (size_t k = 0; k < chains.size() && reach.drives.size() < wanted.drives; ++k) {
    const Stretch& stretch = stretches.FindNext();
    if (static_cast<int>(stretch.length()) == steps) reach.drives.push_back({part, chains[k].q});
    if (k > 0 && stretch.length() <= longest.length()) continue;
    longest = stretch;
    begin = chains[k].begin;
  }
  if (!reach.drives.empty()) return true;
  reach.ladder.reset();
  // Touched only between the states.
  part = CutPath(part, (begin + static_cast<double>(longest.first)) / steps,
                 (begin + static_cast<double>(longest.last)) / steps);
  return part.length_m() >= wanted.part_m;
}

/// One roll. A part is solved again by itself, at poses of its own, so that it is reachable when it is looked at again.
RollReach FindRollReach(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                        const ArmReachSettings& settings, const Wanted& wanted) {
  constexpr int kCuts = 6;
  RollReach reach;
  ScanPath part = path;
  for (int cut = 0; cut < kCuts && reach.drives.empty(); ++cut) {
    if (!FollowPart(arm, clearance, settings, wanted, part, reach)) break;
    reach.whole = cut == 0 && !reach.drives.empty();
  }
  return reach;
}

/// Both directions of each drive, the longer path first.
std::vector<ArmDrive> MakeBothWays(std::vector<ArmDrive> drives) {
  std::vector<ArmDrive> both;
  for (ArmDrive& drive : drives) {
    ArmDrive back{ReversePath(drive.path), {drive.q.rbegin(), drive.q.rend()}};
    both.push_back(std::move(drive));
    both.push_back(std::move(back));
  }
  std::stable_sort(both.begin(), both.end(), [](const ArmDrive& a, const ArmDrive& b) {
    return CountMillimetres(a.path) > CountMillimetres(b.path);
  });
  return both;
}

/// Looks at the rolls of a path: as it stands and by half a turn, then askew.
class Rolls {
 public:
  /// @param only_longest  One drive is enough that is as long as any; rolls that cannot have a longer one are passed
  /// over.
  Rolls(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path, const ArmReachSettings& settings,
        bool only_longest)
      : arm_(arm), clearance_(clearance), path_(path), settings_(settings), only_longest_(only_longest) {
    Look(0.0);
    for (const double skew_rad : settings.skews_rad) {
      if (whole_.empty()) Look(skew_rad);
    }
  }

  ArmReach Finish() {
    if (!whole_.empty()) return {Verdict::kReachable, MakeBothWays(std::move(whole_))};
    if (!parts_.empty()) return {Verdict::kPartly, MakeBothWays(std::move(parts_))};
    Verdict verdict = Verdict::kNoInverseKinematics;
    for (RollReach& reach : stuck_) {
      const Verdict reason = reach.FindReason();
      if (RankOf(reason) > RankOf(verdict)) verdict = reason;
    }
    return {verdict, {}};
  }

 private:
  void Look(double skew_rad) {
    const ScanPath turned = TurnPath(path_, skew_rad);
    LookAt(turned, skew_rad);
    if (settings_.half_turns) LookAt(RollPath(turned), skew_rad);
  }

  void LookAt(const ScanPath& roll, double skew_rad) {
    if (only_longest_ && !whole_.empty()) return;
    RollReach reach = FindRollReach(arm_, clearance_, roll, settings_, FindWanted());
    std::vector<ArmDrive>& drives = reach.whole ? whole_ : parts_;
    for (ArmDrive& drive : reach.drives) drives.push_back(std::move(drive));
    if (skew_rad == 0.0 && reach.drives.empty()) stuck_.push_back(std::move(reach));
  }

  Wanted FindWanted() const {
    Wanted wanted{settings_.min_part_m - kRounding_m, settings_.drives};
    if (path_.length_m() < settings_.min_part_m) wanted.part_m = 0.0;  // whole or not at all
    if (!only_longest_) return wanted;
    wanted.drives = 1;
    for (const ArmDrive& part : parts_) {
      const double longer_m = (static_cast<double>(CountMillimetres(part.path)) + 0.5) * kSameLength_m;
      wanted.part_m = std::max(wanted.part_m, longer_m - kRounding_m);
    }
    return wanted;
  }

  const ArmSetup& arm_;
  const Clearance& clearance_;
  const ScanPath& path_;
  const ArmReachSettings& settings_;
  bool only_longest_;
  std::vector<ArmDrive> whole_;
  std::vector<ArmDrive> parts_;
  std::vector<RollReach> stuck_;
};

}  // namespace

ArmReach FindArmReach(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                      const ArmReachSettings& settings) {
  return Rolls(arm, clearance, path, settings, false).Finish();
}

PathCheck CheckArmPath(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                       const ArmReachSettings& settings) {
  const ArmReach reach = Rolls(arm, clearance, path, settings, true).Finish();
  return {reach.verdict, reach.drives.empty() ? path : reach.drives.front().path};
}

}  // namespace nbs
