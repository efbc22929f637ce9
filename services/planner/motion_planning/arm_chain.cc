#include "services/planner/motion_planning/arm_chain.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

/// Joint values at one pose of the line, with the best chain that ends there.
struct Node {
  Joints q;
  ArmTouch touch = ArmTouch::kFree;
  std::vector<int> from;  ///< Nodes of the pose before that lead here.
  int poses = 0;          ///< Of the chain; 0: the node is not used.
  int before = -1;        ///< Node of the pose before, on the chain.
  double travel_rad = 0.0;
};

using Layer = std::vector<Node>;

class Ladder {
 public:
  Ladder(const InverseKinematics& ik, const ArmCollision& collision, const Clearance& clearance,
         const std::vector<Pose>& X_WF, double step_s, const ChainSettings& settings)
      : model_(ik.model()), step_s_(step_s), settings_(settings) {
    const Pose X_BW = collision.X_WB().inverse();
    std::vector<Joints> near;
    for (const Pose& pose : X_WF) {
      X_BF_.push_back(X_BW * pose);
      Layer layer;
      for (const Joints& q : ik.FindAll(X_BF_.back(), near)) layer.push_back({q, {}, {}, 0, -1, 0.0});
      Touch(collision, clearance, layer);
      near.clear();
      for (const Node& node : layer) near.push_back(node.q);
      layers_.push_back(std::move(layer));
    }
    for (size_t k = 1; k < layers_.size(); ++k) Join(k);
  }

  /// Chains over nodes that touch nothing worse than `worst`; returns the poses of the longest.
  int FindLongest(ArmTouch worst) {
    int longest = 0;
    for (size_t k = 0; k < layers_.size(); ++k) {
      for (Node& node : layers_[k]) {
        node.poses = node.touch <= worst ? 1 : 0;
        node.before = -1;
        node.travel_rad = 0.0;
        if (node.poses > 0 && k > 0) Extend(layers_[k - 1], node);
        longest = std::max(longest, node.poses);
      }
    }
    return longest;
  }

  /// The longest run of poses with any joint values at all.
  int FindLongestRun() const {
    int longest = 0;
    int run = 0;
    for (const Layer& layer : layers_) {
      run = layer.empty() ? 0 : run + 1;
      longest = std::max(longest, run);
    }
    return longest;
  }

  const std::vector<Pose>& X_BF() const { return X_BF_; }

  /// One chain of that length for each node that can begin one.
  std::vector<JointChain> Collect(int poses) const {
    std::vector<JointChain> chains;
    std::vector<std::pair<int, int>> begun;
    for (size_t k = 0; k < layers_.size(); ++k) {
      for (const Node& node : layers_[k]) {
        if (node.poses != poses) continue;
        auto [first, chain] = Trace(k, node);
        const auto known = std::find(begun.begin(), begun.end(), first);
        if (known == begun.end()) {
          begun.push_back(first);
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

 private:
  /// Whole turns of joints put the arm in the same place.
  static void Touch(const ArmCollision& collision, const Clearance& clearance, Layer& layer) {
    constexpr double kWholeTurn = 6.0;  // rad; joint values of other solutions do not differ by whole turns alone
    for (size_t i = 0; i < layer.size(); ++i) {
      const auto same =
          std::find_if(layer.begin(), layer.begin() + static_cast<std::ptrdiff_t>(i), [&](const Node& other) {
            return (layer[i].q - other.q)
                .unaryExpr([](double d) { return std::abs(d) < 1e-12 || std::abs(d) > kWholeTurn; })
                .all();
          });
      const bool known = same != layer.begin() + static_cast<std::ptrdiff_t>(i);
      layer[i].touch = known ? same->touch : collision.FindTouch(clearance, layer[i].q);
    }
  }

  bool AreJoined(size_t k, const Joints& q_from, const Joints& q_to) const {
    for (int j = 0; j < model_.n(); ++j) {
      if (std::abs(q_to[j] - q_from[j]) > model_.joints[static_cast<size_t>(j)].max_rad_per_s * step_s_) return false;
    }
    const Pose X_BF = CalcFlangePose(model_, 0.5 * (q_from + q_to));
    const Pose X_BF_line = Interpolate(X_BF_[k - 1], X_BF_[k], 0.5);
    return (X_BF.translation() - X_BF_line.translation()).norm() <= settings_.largest_off_m &&
           CalcAngleBetween(X_BF, X_BF_line) <= settings_.largest_off_rad;
  }

  void Join(size_t k) {
    constexpr double kFarthest = 1.0;  // rad; quicker than AreJoined
    for (Node& node : layers_[k]) {
      for (size_t i = 0; i < layers_[k - 1].size(); ++i) {
        const Joints& q_from = layers_[k - 1][i].q;
        if ((node.q - q_from).cwiseAbs().sum() < kFarthest && AreJoined(k, q_from, node.q))
          node.from.push_back(static_cast<int>(i));
      }
    }
  }

  static void Extend(const Layer& before, Node& node) {
    for (const int i : node.from) {
      const Node& from = before[static_cast<size_t>(i)];
      if (from.poses == 0) continue;
      const double travel = from.travel_rad + (node.q - from.q).cwiseAbs().sum();
      const bool better = from.poses + 1 > node.poses || (from.poses + 1 == node.poses && travel < node.travel_rad);
      if (!better) continue;
      node.poses = from.poses + 1;
      node.travel_rad = travel;
      node.before = i;
    }
  }

  std::pair<std::pair<int, int>, JointChain> Trace(size_t k, const Node& last) const {
    JointChain chain;
    chain.travel_rad = last.travel_rad;
    const Node* node = &last;
    int number = static_cast<int>(&last - layers_[k].data());
    while (true) {
      chain.q.push_back(node->q);
      if (node->before < 0) break;
      number = node->before;
      node = &layers_[--k][static_cast<size_t>(number)];
    }
    std::reverse(chain.q.begin(), chain.q.end());
    chain.begin = static_cast<int>(k);
    return std::make_pair(std::make_pair(static_cast<int>(k), number), std::move(chain));
  }

  const ArmModel& model_;
  double step_s_;
  ChainSettings settings_;
  std::vector<Pose> X_BF_;
  std::vector<Layer> layers_;
};

/// Why there is no chain of so many poses over free nodes.
Verdict FindReason(const InverseKinematics& ik, Ladder& ladder, int wanted) {
  if (ladder.FindLongest(ArmTouch::kUnknown) >= wanted) return Verdict::kBlockedByUnknown;
  if (ladder.FindLongest(ArmTouch::kOccupied) >= wanted) return Verdict::kBlockedByObstacle;
  if (ladder.FindLongest(ArmTouch::kSelf) >= wanted) return Verdict::kSelfCollision;
  if (ladder.FindLongestRun() >= wanted) return Verdict::kSpeed;
  int run = 0;
  for (const Pose& X_BF : ladder.X_BF()) {
    run = ik.IsInReach(X_BF) ? run + 1 : 0;
    if (run >= wanted) return Verdict::kJointLimit;
  }
  return Verdict::kNoInverseKinematics;
}

}  // namespace

ChainResult FindChains(const InverseKinematics& ik, const ArmCollision& collision, const Clearance& clearance,
                       const std::vector<Pose>& X_WF, double step_s, int wanted, const ChainSettings& settings) {
  Ladder ladder(ik, collision, clearance, X_WF, step_s, settings);
  const int longest = ladder.FindLongest(ArmTouch::kFree);
  if (longest >= wanted) return {ladder.Collect(longest), Verdict::kReachable};
  return {{}, FindReason(ik, ladder, wanted)};
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
