#include "services/planner/motion_planning/arm_collision.h"

#include <algorithm>
#include <limits>

#include "common/kinematics/shape_distance.h"
#include "services/planner/motion_planning/collision_body.h"

namespace nbs {
namespace {

constexpr double kSmallestRate = 1e-9;

std::vector<Capsule> MakeTool(const CellConfig& cell) {
  std::vector<Capsule> tool_F;
  for (const Sphere& sphere : MoveSpheres(cell.X_FS, cell.sensor_body_S))
    tool_F.push_back({sphere.center, sphere.center, sphere.radius_m});
  return tool_F;
}

Capsule Move(const Pose& X_WL, const Capsule& c, double margin_m) {
  return {X_WL * c.p_A, X_WL * c.p_B, c.radius_m + margin_m};
}

Block Move(const Pose& X_WL, const Block& block) { return {X_WL * block.X_LC, block.half}; }

}  // namespace

ArmCollision::ArmCollision(const RunConfig& config, const ArmModel& model)
    : model_(model),
      body_(model, MakeTool(config.cell)),
      X_WB_(CalcBasePose(config)),
      margin_m_(config.cell.body_margin_m) {
  if (!config.cell.table_z_m) return;
  constexpr double kDeep = 10.0;
  Table table;
  table.top_z_m = *config.cell.table_z_m;
  table.half << config.cell.table_half_m, kDeep;
  table.at_W = config.p_WO.head<2>();
  table_ = table;
}

double ArmCollision::CalcFixedDistance(size_t part, const Eigen::Vector3d& p_W) const {
  double distance = std::numeric_limits<double>::infinity();
  if (part > 0) distance = p_W.z() - X_WB_.translation().z();
  if (table_) {
    const double above = std::max(0.0, p_W.z() - table_->top_z_m);
    const double to_table = is_sensor(part) ? above : CalcBoxDistance(p_W - table_->middle_W(), table_->half);
    distance = std::min(distance, to_table);
  }
  return distance;
}

double ArmCollision::CalcPartSlack(const Clearance& clearance, size_t part, const Pose& X_WL, double enough_m) const {
  const ArmPart& of = body_.parts()[part];
  const auto slack_of = [&](const Capsule& sphere) {
    const Eigen::Vector3d p_W = X_WL * sphere.p_A;
    return std::min(clearance.CalcUnknownDistance(p_W), CalcFixedDistance(part, p_W)) - sphere.radius_m - margin_m_;
  };
  const double around = slack_of(of.bound);
  if (around >= enough_m || of.spheres.size() == 1) return around;
  double slack = std::numeric_limits<double>::infinity();
  for (const Capsule& sphere : of.spheres) slack = std::min(slack, slack_of(sphere));
  return slack;
}

bool ArmCollision::TouchesFixed(size_t part, const Capsule& capsule_W) const {
  const double low = std::min(capsule_W.p_A.z(), capsule_W.p_B.z()) - capsule_W.radius_m;
  if (part > 0 && low < X_WB_.translation().z()) return true;
  if (!table_) return false;
  if (is_sensor(part)) return low < table_->top_z_m;
  const Eigen::Vector3d middle_W = table_->middle_W();
  return CalcSegmentBoxDistance(capsule_W.p_A - middle_W, capsule_W.p_B - middle_W, table_->half) < capsule_W.radius_m;
}

bool ArmCollision::TouchesFixed(size_t part, const Block& block_W, double margin_m) const {
  const double low = block_W.X_LC.translation().z() - block_W.X_LC.linear().row(2).cwiseAbs().dot(block_W.half);
  if (part > 0 && low - margin_m < X_WB_.translation().z()) return true;
  if (!table_) return false;
  if (is_sensor(part)) return low - margin_m < table_->top_z_m;
  Block moved = block_W;
  moved.X_LC.translation() -= table_->middle_W();
  return CalcBlockBoxDistance(moved, table_->half) < margin_m;
}

bool ArmCollision::TouchesFixed(size_t part, const Pose& X_WL, double margin_m) const {
  const ArmPart& of = body_.parts()[part];
  if (CalcFixedDistance(part, X_WL * of.bound.p_A) >= of.bound.radius_m + margin_m) return false;
  return std::any_of(of.capsules.begin(), of.capsules.end(),
                     [&](const Capsule& c) { return TouchesFixed(part, Move(X_WL, c, margin_m)); }) ||
         std::any_of(of.blocks.begin(), of.blocks.end(),
                     [&](const Block& b) { return TouchesFixed(part, Move(X_WL, b), margin_m); });
}

bool ArmCollision::TouchesMap(const Clearance& clearance, Obstacles obstacles, size_t part, const Pose& X_WL,
                              double margin_m) const {
  const ArmPart& of = body_.parts()[part];
  if (clearance.CalcDistance(obstacles, X_WL * of.bound.p_A) >= of.bound.radius_m + margin_m) return false;
  return std::any_of(of.capsules.begin(), of.capsules.end(),
                     [&](const Capsule& c) { return clearance.IsTouched(obstacles, Move(X_WL, c, margin_m)); }) ||
         std::any_of(of.blocks.begin(), of.blocks.end(),
                     [&](const Block& b) { return clearance.IsTouched(obstacles, Move(X_WL, b), margin_m); });
}

bool ArmCollision::TouchesItself(const LinkPoses& X_BL, double margin_m) const {
  for (size_t part = 0; part < body_.parts().size(); ++part) {
    if (TouchesFixed(part, CalcPartPose(part, X_BL), margin_m)) return true;
  }
  return body_.CalcSelfDistance(X_BL, kSelfMargin) < kSelfMargin;
}

bool ArmCollision::TouchesMap(const Clearance& clearance, Obstacles obstacles, const Joints& q, double margin_m) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  return TouchesMap(clearance, obstacles, X_BL, margin_m);
}

bool ArmCollision::TouchesMap(const Clearance& clearance, Obstacles obstacles, const LinkPoses& X_BL,
                              double margin_m) const {
  // From the sensor down: what moves most touches most often.
  for (size_t part = body_.parts().size(); part-- > 0;) {
    if (TouchesMap(clearance, obstacles, part, CalcPartPose(part, X_BL), margin_m)) return true;
  }
  return false;
}

ArmTouch ArmCollision::FindTouch(const Clearance& clearance, const Joints& q) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  if (TouchesItself(X_BL, margin_m_)) return ArmTouch::kSelf;
  if (!TouchesMap(clearance, Obstacles::kOccupiedOrUnknown, X_BL, margin_m_)) return ArmTouch::kFree;
  return TouchesMap(clearance, Obstacles::kOccupied, X_BL, margin_m_) ? ArmTouch::kOccupied : ArmTouch::kUnknown;
}

bool ArmCollision::Touches(const Clearance& clearance, const Joints& q, ArmTouch worst) const {
  if (worst == ArmTouch::kSelf) return false;
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  if (TouchesItself(X_BL, margin_m_)) return true;
  if (worst == ArmTouch::kOccupied) return false;
  const Obstacles obstacles = worst == ArmTouch::kFree ? Obstacles::kOccupiedOrUnknown : Obstacles::kOccupied;
  return TouchesMap(clearance, obstacles, X_BL, margin_m_);
}

bool ArmCollision::IsFree(const Clearance& clearance, const Joints& q, double squeeze_m) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  return !TouchesItself(X_BL, margin_m_ - squeeze_m) &&
         !TouchesMap(clearance, Obstacles::kOccupiedOrUnknown, X_BL, margin_m_ - squeeze_m);
}

ArmTouch ArmCollision::FindSensorTouch(const Clearance& clearance, const Pose& X_WF) const {
  const size_t part = body_.parts().size() - 1;
  if (!is_sensor(part)) return ArmTouch::kFree;
  const Pose X_WL = X_WF * model_.X_LF.inverse();
  if (TouchesFixed(part, X_WL, margin_m_)) return ArmTouch::kSelf;
  if (!TouchesMap(clearance, Obstacles::kOccupiedOrUnknown, part, X_WL, margin_m_)) return ArmTouch::kFree;
  return TouchesMap(clearance, Obstacles::kOccupied, part, X_WL, margin_m_) ? ArmTouch::kOccupied : ArmTouch::kUnknown;
}

std::optional<double> ArmCollision::FindSqueeze(const Clearance& clearance, const Joints& q) const {
  constexpr double kStep = 1e-3;
  if (IsFree(clearance, q)) return 0.0;
  if (!IsFree(clearance, q, margin_m_)) return std::nullopt;
  double low = 0.0;
  double high = margin_m_;
  while (high - low > kStep) {
    const double middle = 0.5 * (low + high);
    (IsFree(clearance, q, middle) ? high : low) = middle;
  }
  return high;
}

double ArmCollision::CalcFreeStep(const Clearance& clearance, const Joints& q, const Joints& way, double left,
                                  double squeeze_m) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  const auto rate_of = [&](int part, int from_joint) {
    double rate = kSmallestRate;
    for (int k = from_joint; k < model_.n(); ++k) rate += std::abs(way[k]) * body_.CalcReach(part, k);
    return rate;
  };
  double step = left;
  double fastest = kSmallestRate;
  for (size_t part = 0; part < body_.parts().size(); ++part) {
    const double rate = rate_of(static_cast<int>(part), 0);
    fastest = std::max(fastest, rate);
    const Pose X_WL = CalcPartPose(part, X_BL);
    const double slack = CalcPartSlack(clearance, part, X_WL, step * rate - squeeze_m) + squeeze_m;
    step = std::min(step, std::max(0.0, slack) / rate);
    // Distances are lower bounds: they leave in doubt what is near.
    if (slack < 0.0 && (TouchesFixed(part, X_WL, margin_m_ - squeeze_m) ||
                        TouchesMap(clearance, Obstacles::kOccupiedOrUnknown, part, X_WL, margin_m_ - squeeze_m)))
      return -1.0;
  }
  for (const ArmBody::Pair& pair : body_.pairs()) {
    // Only the joints between the two parts change their distance.
    const double rate = rate_of(pair.b, body_.parts()[static_cast<size_t>(pair.a)].link);
    const double slack = body_.CalcPairDistance(pair, X_BL, kSelfMargin + step * rate) - kSelfMargin;
    if (slack < 0.0) return -1.0;
    step = std::min(step, slack / rate);
  }
  return std::max(step, kArmSweepTolerance / fastest);
}

bool ArmCollision::IsFreeMotion(const Clearance& clearance, const Joints& q_from, const Joints& q_to,
                                double squeeze_m) const {
  const Joints way = q_to - q_from;
  // The end is the state most often blocked where a search tries to connect.
  if (!IsFree(clearance, q_to, squeeze_m)) return false;
  for (double share = 0.0; share < 1.0;) {
    const double step = CalcFreeStep(clearance, q_from + share * way, way, 1.0 - share, squeeze_m);
    if (step < 0.0) return false;
    share += step;
  }
  return true;
}

}  // namespace nbs
