#include "sim/robot_body.h"

#include <algorithm>
#include <stdexcept>

#include "common/config/cell_arm.h"

namespace nbs {
namespace {

std::vector<Capsule> MakeTool(const CellConfig& cell) {
  std::vector<Capsule> tool_F;
  for (const Sphere& sphere : cell.sensor_body_S) {
    const Eigen::Vector3d p_F = cell.X_FS * sphere.center;
    tool_F.push_back({p_F, p_F, sphere.radius_m});
  }
  return tool_F;
}

Capsule Move(const Pose& X_WL, const Capsule& c) { return {X_WL * c.p_A, X_WL * c.p_B, c.radius_m}; }

}  // namespace

RobotBody::RobotBody(const RunConfig& config) : tool_F_(MakeTool(config.cell)) {
  if (!config.cell.arm) return;
  arm_ = ReadCellArm(config.cell);
  body_.emplace(*arm_, tool_F_);
  X_WB_ = CalcBasePose(config);
}

Posture RobotBody::MakePosture(int64_t utime_us, const Joints& q, bool scanning) const {
  if (q.size() != arm_.value().n()) {
    throw std::invalid_argument("RobotBody: " + std::to_string(q.size()) + " joint values for an arm of " +
                                std::to_string(arm_->n()));
  }
  return {utime_us, X_WB_ * CalcFlangePose(*arm_, q), q, scanning};
}

Posture RobotBody::Interpolate(const Posture& from, const Posture& to, double share) const {
  const int64_t utime_us = from.utime_us + std::llround(share * static_cast<double>(to.utime_us - from.utime_us));
  if (arm_) return MakePosture(utime_us, from.q + share * (to.q - from.q), from.scanning);
  return {utime_us, nbs::Interpolate(from.X_WF, to.X_WF, share), {}, from.scanning};
}

double RobotBody::CalcTravel(const Posture& from, const Posture& to) const {
  double farthest = 0.0;
  if (body_) {
    const Joints way = (to.q - from.q).cwiseAbs();
    for (size_t part = 0; part < body_->parts().size(); ++part) {
      double travel = 0.0;
      for (int k = 0; k < arm_->n(); ++k) travel += way[k] * body_->CalcReach(static_cast<int>(part), k);
      farthest = std::max(farthest, travel);
    }
    return farthest;
  }
  const double turn = CalcAngleBetween(from.X_WF, to.X_WF);
  for (const Capsule& sphere : tool_F_) farthest = std::max(farthest, turn * (sphere.p_A.norm() + sphere.radius_m));
  return farthest + (to.X_WF.translation() - from.X_WF.translation()).norm();
}

std::vector<PlacedPart> RobotBody::Place(const Posture& posture, const Eigen::Vector3d& offset_W) const {
  std::vector<PlacedPart> parts;
  const Pose X_off(Eigen::Translation3d(offset_W) * Pose::Identity());
  if (body_) {
    LinkPoses X_BL;
    CalcLinkPoses(*arm_, posture.q, X_BL);
    for (const ArmPart& part : body_->parts()) {
      const Pose X_WL = X_WB_ * X_BL[static_cast<size_t>(part.link)];
      const Pose X_true = part.link == 0 ? X_WL : X_off * X_WL;
      PlacedPart placed{part.name, part.link, {}, {}};
      for (const Capsule& capsule : part.capsules) placed.capsules_W.push_back(Move(X_true, capsule));
      for (const Block& block : part.blocks) placed.blocks_W.push_back({X_true * block.X_LC, block.half});
      parts.push_back(std::move(placed));
    }
    return parts;
  }
  PlacedPart sensor{"sensor", 1, {}, {}};
  for (const Capsule& sphere : tool_F_) sensor.capsules_W.push_back(Move(X_off * posture.X_WF, sphere));
  parts.push_back(std::move(sensor));
  return parts;
}

std::optional<std::string> RobotBody::FindSelfContact(const Posture& posture) const {
  if (!body_) return std::nullopt;
  LinkPoses X_BL;
  CalcLinkPoses(*arm_, posture.q, X_BL);
  std::optional<std::string> names;
  double smallest = 0.0;
  for (const ArmBody::Pair& pair : body_->pairs()) {
    const double distance = body_->CalcPairDistance(pair, X_BL, 0.01);
    const bool meets = distance < smallest || (distance <= 0.0 && !names);
    if (!meets) continue;
    smallest = std::min(smallest, distance);
    names =
        body_->parts()[static_cast<size_t>(pair.a)].name + " and " + body_->parts()[static_cast<size_t>(pair.b)].name;
  }
  return names;
}

}  // namespace nbs
