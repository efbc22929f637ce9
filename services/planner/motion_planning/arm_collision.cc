#include "services/planner/motion_planning/arm_collision.h"

#include <algorithm>
#include <limits>

#include "services/planner/motion_planning/collision_body.h"

namespace nbs {
namespace {

/// Distances beyond this need not be exact.
constexpr double kWellClear = 0.15;  // metres
constexpr double kSmallestRate = 1e-9;

std::vector<Capsule> MakeTool(const CellConfig& cell) {
  const std::vector<Sphere> spheres_S = cell.sensor_body_S.empty() ? MakeDefaultSensorBody() : cell.sensor_body_S;
  std::vector<Capsule> tool_F;
  for (const Sphere& sphere : MoveSpheres(cell.X_FS, spheres_S))
    tool_F.push_back({sphere.center, sphere.center, sphere.radius_m});
  return tool_F;
}

Eigen::AlignedBox2d MakeTable(const RunConfig& config) {
  const Eigen::Vector2d middle_W = config.p_WO.head<2>();
  return {middle_W - config.cell.table_half_m, middle_W + config.cell.table_half_m};
}

}  // namespace

ArmCollision::ArmCollision(const RunConfig& config, const ArmModel& model)
    : model_(model),
      body_(model, MakeTool(config.cell)),
      X_WB_(CalcBasePose(config)),
      margin_m_(config.cell.body_margin_m),
      table_z_m_(config.cell.table_z_m),
      table_W_(MakeTable(config)) {}

double ArmCollision::CalcFixedDistance(size_t part, const Eigen::Vector3d& p_W) const {
  double distance = std::numeric_limits<double>::infinity();
  if (part > 0) distance = p_W.z() - X_WB_.translation().z();
  if (table_z_m_) {
    const bool is_sensor = part > static_cast<size_t>(model_.n());
    const double aside = is_sensor ? 0.0 : table_W_.exteriorDistance(p_W.head<2>());
    distance = std::min(distance, std::hypot(aside, std::max(0.0, p_W.z() - *table_z_m_)));
  }
  return distance;
}

double ArmCollision::CalcPartSlack(const Clearance& clearance, size_t part, const LinkPoses& X_BL) const {
  const ArmPart& of = body_.parts()[part];
  const Pose X_WL = X_WB_ * X_BL[static_cast<size_t>(of.link)];
  const auto slack_of = [&](const Capsule& sphere) {
    const Eigen::Vector3d p_W = X_WL * sphere.p_A;
    return std::min(clearance.CalcUnknownDistance(p_W), CalcFixedDistance(part, p_W)) - sphere.radius_m - margin_m_;
  };
  const double around = slack_of(of.bound);
  if (around > kWellClear || of.spheres.size() == 1) return around;
  double slack = std::numeric_limits<double>::infinity();
  for (const Capsule& sphere : of.spheres) slack = std::min(slack, slack_of(sphere));
  return slack;
}

double ArmCollision::CalcSlack(const Clearance& clearance, const Joints& q) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  double slack = std::numeric_limits<double>::infinity();
  for (size_t part = 0; part < body_.parts().size(); ++part)
    slack = std::min(slack, CalcPartSlack(clearance, part, X_BL));
  return slack;
}

ArmTouch ArmCollision::FindTouch(const Clearance& clearance, const Joints& q) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  if (body_.CalcSelfDistance(X_BL, kSelfMargin + 0.01) < kSelfMargin) return ArmTouch::kSelf;
  ArmTouch touch = ArmTouch::kFree;
  for (size_t part = 0; part < body_.parts().size(); ++part) {
    if (CalcPartSlack(clearance, part, X_BL) >= 0.0) continue;
    touch = std::max(touch, ArmTouch::kUnknown);
    const ArmPart& of = body_.parts()[part];
    const Pose X_WL = X_WB_ * X_BL[static_cast<size_t>(of.link)];
    for (const Capsule& sphere : of.spheres) {
      const Eigen::Vector3d p_W = X_WL * sphere.p_A;
      const double reach = sphere.radius_m + margin_m_;
      if (CalcFixedDistance(part, p_W) < reach) return ArmTouch::kSelf;
      if (clearance.CalcObstacleDistance(p_W) < reach) touch = ArmTouch::kOccupied;
    }
  }
  return touch;
}

bool ArmCollision::Touches(const Clearance& clearance, const Joints& q, ArmTouch worst) const {
  return FindTouch(clearance, q) > worst;
}

ArmTouch ArmCollision::FindSensorTouch(const Clearance& clearance, const Pose& X_WF) const {
  ArmTouch touch = ArmTouch::kFree;
  const size_t part = body_.parts().size() - 1;
  const ArmPart& of = body_.parts()[part];
  if (static_cast<int>(part) <= model_.n()) return touch;
  const Pose X_WL = X_WF * model_.X_LF.inverse();
  for (const Capsule& sphere : of.spheres) {
    const Eigen::Vector3d p_W = X_WL * sphere.p_A;
    const double reach = sphere.radius_m + margin_m_;
    if (CalcFixedDistance(part, p_W) < reach) return ArmTouch::kSelf;
    if (clearance.CalcUnknownDistance(p_W) < reach)
      touch = std::max(touch, clearance.CalcObstacleDistance(p_W) < reach ? ArmTouch::kOccupied : ArmTouch::kUnknown);
  }
  return touch;
}

double ArmCollision::CalcFreeStep(const Clearance& clearance, const Joints& q, const Joints& way,
                                  double squeeze_m) const {
  LinkPoses X_BL;
  CalcLinkPoses(model_, q, X_BL);
  const auto rate_of = [&](int part, int from_joint) {
    double rate = kSmallestRate;
    for (int k = from_joint; k < model_.n(); ++k) rate += std::abs(way[k]) * body_.CalcReach(part, k);
    return rate;
  };
  double step = std::numeric_limits<double>::infinity();
  double fastest = kSmallestRate;
  for (size_t part = 0; part < body_.parts().size(); ++part) {
    const double slack = CalcPartSlack(clearance, part, X_BL) + squeeze_m;
    if (slack < 0.0) return -1.0;
    const double rate = rate_of(static_cast<int>(part), 0);
    fastest = std::max(fastest, rate);
    step = std::min(step, slack / rate);
  }
  for (const ArmBody::Pair& pair : body_.pairs()) {
    const double slack = body_.CalcPairDistance(pair, X_BL, kWellClear) - kSelfMargin;
    if (slack < 0.0) return -1.0;
    // Only the joints between the two parts change their distance.
    step = std::min(step, slack / rate_of(pair.b, body_.parts()[static_cast<size_t>(pair.a)].link));
  }
  return std::max(step, kArmSweepTolerance / fastest);
}

bool ArmCollision::IsFreeMotion(const Clearance& clearance, const Joints& q_from, const Joints& q_to,
                                double squeeze_m) const {
  const Joints way = q_to - q_from;
  // The end is the state most often blocked where a search tries to connect.
  if (CalcFreeStep(clearance, q_to, way, squeeze_m) < 0.0) return false;
  for (double share = 0.0; share < 1.0;) {
    const double step = CalcFreeStep(clearance, q_from + share * way, way, squeeze_m);
    if (step < 0.0) return false;
    share += step;
  }
  return true;
}

}  // namespace nbs
