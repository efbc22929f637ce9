#include "common/kinematics/arm_body.h"

#include <algorithm>
#include <limits>

#include "common/kinematics/shape_distance.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

Capsule MakeBound(const std::vector<Capsule>& spheres) {
  Eigen::AlignedBox3d box;
  for (const Capsule& sphere : spheres) {
    box.extend((sphere.p_A.array() - sphere.radius_m).matrix());
    box.extend((sphere.p_A.array() + sphere.radius_m).matrix());
  }
  Capsule bound{box.center(), box.center(), 0.0};
  for (const Capsule& sphere : spheres)
    bound.radius_m = std::max(bound.radius_m, (sphere.p_A - bound.p_A).norm() + sphere.radius_m);
  return bound;
}

void Cover(ArmPart& part, double overshoot_m) {
  std::vector<Capsule> capsules = part.capsules;
  for (const Block& block : part.blocks) {
    const std::vector<Capsule> rows = CoverBlock(block);
    capsules.insert(capsules.end(), rows.begin(), rows.end());
  }
  for (const Capsule& capsule : capsules) {
    const std::vector<Capsule> spheres = CoverCapsule(capsule, overshoot_m);
    part.spheres.insert(part.spheres.end(), spheres.begin(), spheres.end());
  }
  part.bound = MakeBound(part.spheres);
}

/// Smallest distance of the capsules of `of` and the blocks of `from`.
double CalcBlockDistance(const ArmPart& of, const Pose& X_BO, const ArmPart& from, const Pose& X_BF) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Block& block : from.blocks) {
    const Pose X_CO = (X_BF * block.X_LC).inverse() * X_BO;
    for (const Capsule& c : of.capsules) {
      smallest = std::min(smallest, CalcSegmentBoxDistance(X_CO * c.p_A, X_CO * c.p_B, block.half) - c.radius_m);
    }
  }
  return smallest;
}

}  // namespace

ArmBody::ArmBody(const ArmModel& model, const std::vector<Capsule>& tool_F, double overshoot_m) {
  for (int k = 0; k <= model.n(); ++k)
    parts_.push_back({model.links[k].name, k, model.links[k].capsules, model.links[k].blocks, {}, {}});
  if (!tool_F.empty()) {
    ArmPart tool{"sensor", model.n(), {}, {}, {}, {}};
    for (const Capsule& c : tool_F) tool.capsules.push_back({model.X_LF * c.p_A, model.X_LF * c.p_B, c.radius_m});
    parts_.push_back(std::move(tool));
  }
  for (ArmPart& part : parts_) Cover(part, overshoot_m);
  for (int b = 2; b < static_cast<int>(parts_.size()); ++b) {
    // Neighbours are left out: for the tool that is the link before it in the list, which carries it.
    for (int a = 0; a + 1 < b; ++a) pairs_.push_back({a, b});
  }
  FindReaches(model);
}

void ArmBody::FindReaches(const ArmModel& model) {
  reach_.assign(parts_.size(), {});
  for (size_t p = 0; p < parts_.size(); ++p) {
    const ArmPart& part = parts_[p];
    double reach = part.bound.p_A.norm() + part.bound.radius_m;
    for (int joint = part.link - 1; joint >= 0; --joint) {
      reach_[p][static_cast<size_t>(joint)] = reach;
      reach += model.joints[joint].X_PJ.translation().norm();
    }
  }
}

double ArmBody::CalcPairDistance(const Pair& pair, const LinkPoses& X_BL, double enough_m) const {
  const ArmPart& a = parts_[static_cast<size_t>(pair.a)];
  const ArmPart& b = parts_[static_cast<size_t>(pair.b)];
  const Pose& X_BA = X_BL[static_cast<size_t>(a.link)];
  const Pose& X_BB = X_BL[static_cast<size_t>(b.link)];
  const double apart = (X_BA * a.bound.p_A - X_BB * b.bound.p_A).norm() - a.bound.radius_m - b.bound.radius_m;
  if (apart >= enough_m) return apart;
  double smallest = std::min(CalcBlockDistance(a, X_BA, b, X_BB), CalcBlockDistance(b, X_BB, a, X_BA));
  if (!a.blocks.empty() && !b.blocks.empty()) {
    for (const Capsule& s : a.spheres) {
      for (const Capsule& t : b.spheres)
        smallest = std::min(smallest, (X_BA * s.p_A - X_BB * t.p_A).norm() - s.radius_m - t.radius_m);
    }
  }
  for (const Capsule& c : a.capsules) {
    const Vector3d p_A = X_BA * c.p_A;
    const Vector3d p_B = X_BA * c.p_B;
    for (const Capsule& d : b.capsules) {
      smallest =
          std::min(smallest, CalcSegmentDistance(p_A, p_B, X_BB * d.p_A, X_BB * d.p_B) - c.radius_m - d.radius_m);
    }
  }
  return smallest;
}

double ArmBody::CalcSelfDistance(const LinkPoses& X_BL, double enough_m) const {
  double smallest = enough_m;
  for (const Pair& pair : pairs_) smallest = std::min(smallest, CalcPairDistance(pair, X_BL, smallest));
  return smallest;
}

}  // namespace nbs
