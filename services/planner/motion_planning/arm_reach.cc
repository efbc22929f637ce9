#include "services/planner/motion_planning/arm_reach.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "services/planner/motion_planning/flange_path.h"

namespace nbs {
namespace {

constexpr double kSameLength = 1e-9;  // metres

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
};

/// The longest stretch of a chain along which the arm is free between its states as well.
Stretch FindFreeStretch(const ArmSetup& arm, const Clearance& clearance, const JointChain& chain) {
  Stretch best;
  size_t first = 0;
  for (size_t k = 1; k <= chain.q.size(); ++k) {
    if (k < chain.q.size() && arm.collision.IsFreeMotion(clearance, chain.q[k - 1], chain.q[k])) continue;
    if (k - 1 - first > best.last - best.first) best = {first, k - 1};
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

/// The longest free stretch of each chain, looked for once for chains that differ by whole turns.
std::vector<Stretch> FindFreeStretches(const ArmSetup& arm, const Clearance& clearance,
                                       const std::vector<JointChain>& chains) {
  std::vector<Stretch> stretches;
  for (size_t k = 0; k < chains.size(); ++k) {
    size_t same = 0;
    while (same < k && !AreTurned(chains[same], chains[k])) ++same;
    stretches.push_back(same < k ? stretches[same] : FindFreeStretch(arm, clearance, chains[k]));
  }
  return stretches;
}

struct RollReach {
  bool whole = false;
  Verdict verdict = Verdict::kReachable;
  std::vector<ArmDrive> drives;
};

/// One roll. A part is solved again by itself, at poses of its own, so that it is reachable when it is looked at again.
RollReach FindRollReach(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                        const ArmReachSettings& settings) {
  constexpr int kCuts = 6;
  const double wanted_m = std::min(settings.min_part_m, path.length_m()) - kSameLength;
  ScanPath part = path;
  for (int cut = 0; cut < kCuts; ++cut) {
    const std::vector<Pose> line_WF = MakeLine(arm.X_FS, part, settings.chain);
    const int steps = static_cast<int>(line_WF.size()) - 1;
    const double step_m = part.length_m() / steps;
    const int wanted = step_m > 0.0 && path.length_m() >= settings.min_part_m
                           ? std::min(steps, static_cast<int>(std::ceil(wanted_m / step_m))) + 1
                           : steps + 1;
    const ChainResult result =
        FindChains(arm.ik, arm.collision, clearance, line_WF, step_m / arm.scan_m_per_s, wanted, settings.chain);
    if (result.chains.empty()) return {false, result.verdict, {}};
    RollReach reach;
    const std::vector<Stretch> stretches = FindFreeStretches(arm, clearance, result.chains);
    size_t longest = 0;
    for (size_t k = 0; k < stretches.size(); ++k) {
      const auto length_of = [&](size_t i) { return stretches[i].last - stretches[i].first; };
      if (static_cast<int>(length_of(k)) == steps && reach.drives.size() < settings.drives)
        reach.drives.push_back({part, result.chains[k].q});
      if (length_of(k) > length_of(longest)) longest = k;
    }
    if (!reach.drives.empty()) {
      reach.whole = cut == 0;
      return reach;
    }
    // Touched only between the states.
    const auto first =
        static_cast<double>(static_cast<size_t>(result.chains[longest].begin) + stretches[longest].first);
    const auto last = static_cast<double>(static_cast<size_t>(result.chains[longest].begin) + stretches[longest].last);
    part = CutPath(part, first / steps, last / steps);
    if (part.length_m() < wanted_m) return {false, Verdict::kBlockedByUnknown, {}};
  }
  return {false, Verdict::kBlockedByUnknown, {}};
}

/// Both directions of each drive, the longer path first.
std::vector<ArmDrive> MakeBothWays(std::vector<ArmDrive> drives) {
  std::vector<ArmDrive> both;
  for (ArmDrive& drive : drives) {
    ArmDrive back{ReversePath(drive.path), {drive.q.rbegin(), drive.q.rend()}};
    both.push_back(std::move(drive));
    both.push_back(std::move(back));
  }
  constexpr double kSame_m = 1e-3;
  std::stable_sort(both.begin(), both.end(), [](const ArmDrive& a, const ArmDrive& b) {
    return std::llround(a.path.length_m() / kSame_m) > std::llround(b.path.length_m() / kSame_m);
  });
  return both;
}

}  // namespace

ArmReach FindArmReach(const ArmSetup& arm, const Clearance& clearance, const ScanPath& path,
                      const ArmReachSettings& settings) {
  std::vector<ArmDrive> whole;
  std::vector<ArmDrive> parts;
  Verdict verdict = Verdict::kNoInverseKinematics;
  const auto look = [&](double skew_rad) {
    const ScanPath turned = TurnPath(path, skew_rad);
    for (const ScanPath& roll : {turned, RollPath(turned)}) {
      RollReach reach = FindRollReach(arm, clearance, roll, settings);
      std::vector<ArmDrive>& drives = reach.whole ? whole : parts;
      for (ArmDrive& drive : reach.drives) drives.push_back(std::move(drive));
      if (skew_rad == 0.0 && RankOf(reach.verdict) > RankOf(verdict)) verdict = reach.verdict;
    }
  };
  look(0.0);
  for (const double skew_rad : settings.skews_rad) {
    if (whole.empty()) look(skew_rad);
  }
  if (!whole.empty()) return {Verdict::kReachable, MakeBothWays(std::move(whole))};
  if (!parts.empty()) return {Verdict::kPartly, MakeBothWays(std::move(parts))};
  return {verdict, {}};
}

}  // namespace nbs
