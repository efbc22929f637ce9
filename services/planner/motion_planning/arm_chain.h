#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/kinematics/inverse_kinematics.h"
#include "common/planning/scan_path.h"
#include "services/planner/motion_planning/arm_collision.h"

namespace nbs {

/// How joints follow a line.
struct ChainSettings {
  double step_m = 0.01;  ///< Between two poses of the line at which joint values are solved.
  double step_rad = 0.05;
  double largest_off_m = 0.0005;  ///< Of the flange, half-way between two poses, from the line; and
  double largest_off_rad = 0.005;
};

/// Joint values along a scan path, at even fractions of it from `begin` to `end`.
struct JointChain {
  int begin = 0;  ///< Number of the first pose of the line.
  std::vector<Joints> q;
  double travel_rad = 0.0;  ///< Sum over all joints and steps.

  int end() const { return begin + static_cast<int>(q.size()) - 1; }
};

/// Follows a line of flange poses with the joints: continuous inverse kinematics.
///
/// At each pose all joint values (whole turns included) are nodes; two of neighbouring poses are joined if no joint
/// jumps or turns faster than it can in the time of a step, and the flange stays on the line half-way. Along nodes that
/// touch nothing the longest chains are found by dynamic programming, with the least travel of the joints.
///
/// Everything is worked out when it is first asked for: where the sensor itself touches, no joint values are solved; no
/// node is checked for collision that no chain of the wanted length can use. Keeps references to what it is made of.
class JointLadder {
 public:
  /// @param X_WF    At even fractions of the line, at least two.
  /// @param step_s  From one pose to the next at the scan speed.
  JointLadder(const InverseKinematics& ik, const ArmCollision& collision, const Clearance& clearance,
              const std::vector<Pose>& X_WF, double step_s, const ChainSettings& settings = {});

  /// The longest chains that touch nothing, one for each start that allows it, least travel first; empty if they have
  /// fewer poses than `wanted`.
  std::vector<JointChain> FindChains(int wanted);

  /// Why there is no chain of so many poses, from what is fixed to what may change.
  ///
  /// @pre FindChains found none.
  Verdict FindReason(int wanted);

 private:
  static constexpr size_t kLevels = 3;  // of ArmTouch, but for the worst

  /// Joint values at one pose of the line, with the best chain that ends there.
  struct Node {
    Joints q;
    int place = 0;   ///< Nodes that differ by whole turns put the arm in the same place.
    int poses = 0;   ///< Of the chain; 0: the node is not used.
    int before = 0;  ///< Node of the pose before, on the chain; -1: it begins here.
    double travel_rad = 0.0;
  };
  /// Nothing, or an answer that was worked out before.
  using Answer = std::optional<bool>;
  struct Rung {
    Pose X_WF = Pose::Identity();
    bool is_open = false;
    std::optional<ArmTouch> sensor;
    bool is_solved = false;
    std::vector<Node> nodes;
    int places = 0;
    std::vector<std::array<Answer, kLevels>> usable;  ///< By place, then by what may be touched.
    std::vector<Answer> joined;                       ///< Place of the rung before, times `places`, plus place.
  };

  int FindLongest(ArmTouch worst, int wanted);
  int FindLongestRun();
  void Open(ArmTouch worst, int wanted);
  void Solve(size_t k);
  bool IsUsable(Rung& rung, const Node& node, ArmTouch worst);
  bool IsJoined(size_t k, const Node& from, const Node& to);
  bool CalcIsJoined(size_t k, const Joints& q_from, const Joints& q_to) const;
  void Extend(size_t k, Node& node);
  std::vector<JointChain> Collect(int poses) const;
  JointChain Trace(size_t k, const Node& last, int& first) const;

  const InverseKinematics& ik_;
  const ArmCollision& collision_;
  const Clearance& clearance_;
  double step_s_;
  ChainSettings settings_;
  Pose X_BW_;
  std::vector<Rung> rungs_;
};

/// Flange poses at even fractions of a scan path, so many that no step is longer than the settings allow.
std::vector<Pose> MakeLine(const Pose& X_FS, const ScanPath& path, const ChainSettings& settings = {});

}  // namespace nbs
