#pragma once

#include <span>
#include <vector>

#include "common/kinematics/arm_model.h"

namespace nbs {

/// A rigid part of an arm, for collision checks: in the frame of the link that it moves with.
struct ArmPart {
  std::string name;
  int link = 0;  ///< Of ArmModel::links.
  std::vector<Capsule> capsules;
  std::vector<Block> blocks;
  std::vector<Capsule> spheres;  ///< That cover the part: capsules without length.
  Capsule bound;                 ///< A sphere around the part.
};

/// The parts of an arm and of the tool on its flange, and how near they come to each other.
///
/// Neighbouring links touch at their joint and are not compared, nor is the tool with the link that carries it.
class ArmBody {
 public:
  /// @param tool_F       Spheres of the tool in the flange's frame; may be empty.
  /// @param overshoot_m  How far the covering spheres may reach out of the parts, > 0.
  ArmBody(const ArmModel& model, const std::vector<Capsule>& tool_F, double overshoot_m = 0.004);

  /// One a link, base first, and the tool last, if there is one.
  const std::vector<ArmPart>& parts() const { return parts_; }

  struct Pair {
    int a = 0;  ///< Of parts(), a < b.
    int b = 0;
  };
  const std::vector<Pair>& pairs() const { return pairs_; }

  /// Distance between two parts, metres; negative where capsules overlap. Beyond `enough_m` any larger lower bound may
  /// come instead.
  double CalcPairDistance(const Pair& pair, const LinkPoses& X_BL, double enough_m) const;

  /// The smallest over all pairs, cut off at `enough_m`.
  double CalcSelfDistance(const LinkPoses& X_BL, double enough_m) const;

  /// Upper bound of how far any point of a part can be from a joint's axis: what it moves per radian, metres; 0 for
  /// joints that do not move it.
  double CalcReach(int part, int joint) const { return reach_[static_cast<size_t>(part)][static_cast<size_t>(joint)]; }

 private:
  void FindReaches(const ArmModel& model);

  std::vector<ArmPart> parts_;
  std::vector<Pair> pairs_;
  std::vector<std::array<double, kMaxJoints>> reach_;
};

}  // namespace nbs
