#include "services/planner/motion_planning/arm_chain.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nbs {
namespace {

/// True if two joint values differ by whole turns alone.
bool AreTurned(const Joints& a, const Joints& b) {
  constexpr double kWholeTurn = 6.0;  // rad; joint values of other solutions do not differ by whole turns alone
  return (a - b).unaryExpr([](double d) { return std::abs(d) < 1e-12 || std::abs(d) > kWholeTurn; }).all();
}

}  // namespace

JointLadder::JointLadder(const InverseKinematics& ik, const ArmCollision& collision, const Clearance& clearance,
                         const std::vector<Pose>& X_WF, double step_s, const ChainSettings& settings)
    : ik_(ik),
      collision_(collision),
      clearance_(clearance),
      step_s_(step_s),
      settings_(settings),
      X_BW_(collision.X_WB().inverse()),
      rungs_(X_WF.size()) {
  for (size_t k = 0; k < X_WF.size(); ++k) rungs_[k].X_WF = X_WF[k];
}

std::vector<JointChain> JointLadder::FindChains(int wanted) {
  const int longest = FindLongest(ArmTouch::kFree, wanted);
  return longest >= wanted ? Collect(longest) : std::vector<JointChain>();
}

Verdict JointLadder::FindReason(int wanted) {
  if (FindLongest(ArmTouch::kUnknown, wanted) >= wanted) return Verdict::kBlockedByUnknown;
  if (FindLongest(ArmTouch::kOccupied, wanted) >= wanted) return Verdict::kBlockedByObstacle;
  if (FindLongest(ArmTouch::kSelf, wanted) >= wanted) return Verdict::kSelfCollision;
  if (FindLongestRun() >= wanted) return Verdict::kSpeed;
  int run = 0;
  for (const Rung& rung : rungs_) {
    run = ik_.IsInReach(X_BW_ * rung.X_WF) ? run + 1 : 0;
    if (run >= wanted) return Verdict::kJointLimit;
  }
  return Verdict::kNoInverseKinematics;
}

/// Chains over nodes that touch nothing worse than `worst`; returns the poses of the longest, if it has so many as are
/// wanted.
int JointLadder::FindLongest(ArmTouch worst, int wanted) {
  Open(worst, wanted);
  int longest = 0;
  for (size_t k = 0; k < rungs_.size(); ++k) {
    Rung& rung = rungs_[k];
    if (rung.is_open) Solve(k);
    for (Node& node : rung.nodes) {
      node.poses = rung.is_open && IsUsable(rung, node, worst) ? 1 : 0;
      node.before = -1;
      node.travel_rad = 0.0;
      if (node.poses > 0 && k > 0) Extend(k, node);
      longest = std::max(longest, node.poses);
    }
  }
  return longest;
}

/// The longest run of poses with any joint values at all.
int JointLadder::FindLongestRun() {
  int longest = 0;
  int run = 0;
  for (size_t k = 0; k < rungs_.size(); ++k) {
    Solve(k);
    run = rungs_[k].nodes.empty() ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

/// Opens the rungs that lie in a run of at least `wanted` where the sensor itself touches nothing worse.
void JointLadder::Open(ArmTouch worst, int wanted) {
  size_t first = 0;
  for (size_t k = 0; k <= rungs_.size(); ++k) {
    if (k < rungs_.size()) {
      Rung& rung = rungs_[k];
      if (worst < ArmTouch::kSelf && !rung.sensor) rung.sensor = collision_.FindSensorTouch(clearance_, rung.X_WF);
      if (worst == ArmTouch::kSelf || *rung.sensor <= worst) continue;
    }
    const bool is_long = static_cast<int>(k - first) >= wanted;
    for (; first < k; ++first) rungs_[first].is_open = is_long;
    if (k < rungs_.size()) rungs_[k].is_open = false;
    first = k + 1;
  }
}

void JointLadder::Solve(size_t k) {
  Rung& rung = rungs_[k];
  if (std::exchange(rung.is_solved, true)) return;
  std::vector<Joints> near;
  if (k > 0) {
    for (const Node& node : rungs_[k - 1].nodes) near.push_back(node.q);
  }
  for (const Joints& q : ik_.FindAll(X_BW_ * rung.X_WF, near)) {
    const auto same =
        std::find_if(rung.nodes.begin(), rung.nodes.end(), [&](const Node& other) { return AreTurned(q, other.q); });
    const int place = same == rung.nodes.end() ? rung.places++ : same->place;
    rung.nodes.push_back({q, place, 0, -1, 0.0});
  }
  rung.usable.resize(static_cast<size_t>(rung.places));
}

bool JointLadder::IsUsable(Rung& rung, const Node& node, ArmTouch worst) {
  if (worst == ArmTouch::kSelf) return true;
  Answer& usable = rung.usable[static_cast<size_t>(node.place)][static_cast<size_t>(worst)];
  if (!usable) usable = !collision_.Touches(clearance_, node.q, worst);
  return *usable;
}

bool JointLadder::IsJoined(size_t k, const Node& from, const Node& to) {
  constexpr double kFarthest = 1.0;  // rad; quicker than CalcIsJoined
  if ((to.q - from.q).cwiseAbs().sum() >= kFarthest) return false;
  Rung& rung = rungs_[k];
  rung.joined.resize(static_cast<size_t>(rungs_[k - 1].places) * static_cast<size_t>(rung.places));
  Answer& joined =
      rung.joined[static_cast<size_t>(from.place) * static_cast<size_t>(rung.places) + static_cast<size_t>(to.place)];
  if (!joined) joined = CalcIsJoined(k, from.q, to.q);
  return *joined;
}

bool JointLadder::CalcIsJoined(size_t k, const Joints& q_from, const Joints& q_to) const {
  const ArmModel& model = ik_.model();
  for (int j = 0; j < model.n(); ++j) {
    if (std::abs(q_to[j] - q_from[j]) > model.joints[static_cast<size_t>(j)].max_rad_per_s * step_s_) return false;
  }
  const Pose X_BF = CalcFlangePose(model, 0.5 * (q_from + q_to));
  const Pose X_BF_line = X_BW_ * Interpolate(rungs_[k - 1].X_WF, rungs_[k].X_WF, 0.5);
  return (X_BF.translation() - X_BF_line.translation()).norm() <= settings_.largest_off_m &&
         CalcAngleBetween(X_BF, X_BF_line) <= settings_.largest_off_rad;
}

void JointLadder::Extend(size_t k, Node& node) {
  const std::vector<Node>& before = rungs_[k - 1].nodes;
  for (size_t i = 0; i < before.size(); ++i) {
    const Node& from = before[i];
    if (from.poses == 0 || !IsJoined(k, from, node)) continue;
    const double travel = from.travel_rad + (node.q - from.q).cwiseAbs().sum();
    const bool better = from.poses + 1 > node.poses || (from.poses + 1 == node.poses && travel < node.travel_rad);
    if (!better) continue;
    node.poses = from.poses + 1;
    node.travel_rad = travel;
    node.before = static_cast<int>(i);
  }
}

/// One chain of that length for each node that can begin one.
std::vector<JointChain> JointLadder::Collect(int poses) const {
  std::vector<JointChain> chains;
  std::vector<std::pair<int, int>> begun;  // the first pose and its node
  for (size_t k = 0; k < rungs_.size(); ++k) {
    for (const Node& node : rungs_[k].nodes) {
      if (node.poses != poses) continue;
      int first = 0;
      JointChain chain = Trace(k, node, first);
      const std::pair<int, int> begin(chain.begin, first);
      const auto known = std::find(begun.begin(), begun.end(), begin);
      if (known == begun.end()) {
        begun.push_back(begin);
        chains.push_back(std::move(chain));
      } else {
        JointChain& other = chains[static_cast<size_t>(known - begun.begin())];
        if (chain.travel_rad < other.travel_rad) other = std::move(chain);
      }
    }
  }
  std::stable_sort(chains.begin(), chains.end(),
                   [](const JointChain& a, const JointChain& b) { return a.travel_rad < b.travel_rad; });
  return chains;
}

/// The best chain that ends at a node of rung k; `first` gets the number of its first node.
JointChain JointLadder::Trace(size_t k, const Node& last, int& first) const {
  JointChain chain;
  chain.travel_rad = last.travel_rad;
  const Node* node = &last;
  first = static_cast<int>(&last - rungs_[k].nodes.data());
  while (true) {
    chain.q.push_back(node->q);
    if (node->before < 0) break;
    first = node->before;
    node = &rungs_[--k].nodes[static_cast<size_t>(first)];
  }
  std::reverse(chain.q.begin(), chain.q.end());
  chain.begin = static_cast<int>(k);
  return chain;
}

std::vector<Pose> MakeLine(const Pose& X_FS, const ScanPath& path, const ChainSettings& settings) {
  const Pose X_SF = X_FS.inverse();
  const double turn_rad = CalcAngleBetween(path.X_WS_start, path.X_WS_end);
  const double steps = std::max(path.length_m() / settings.step_m, turn_rad / settings.step_rad);
  const int n = std::max(1, static_cast<int>(std::ceil(steps - 1e-9)));
  std::vector<Pose> X_WF = {path.X_WS_start * X_SF};
  for (int k = 1; k < n; ++k)
    X_WF.push_back(Interpolate(path.X_WS_start, path.X_WS_end, static_cast<double>(k) / n) * X_SF);
  X_WF.push_back(path.X_WS_end * X_SF);
  return X_WF;
}

}  // namespace nbs
