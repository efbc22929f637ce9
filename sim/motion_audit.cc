#include "sim/motion_audit.h"

#include <algorithm>
#include <cmath>

#include "sim/motion_rates.h"
#include "sim/pose_error.h"
#include "sim/scene.h"
#include "sim/solid_distance.h"

namespace nbs {
namespace {

constexpr double kStep_m = 0.01;

/// The table as a solid that reaches down to the floor, or far where there is none.
std::optional<Block> MakeTable(const RunConfig& config, const RobotBody& robot) {
  if (!config.cell.table_z_m) return std::nullopt;
  constexpr double kDeep_m = 10.0;
  const double top = *config.cell.table_z_m;
  const double bottom = robot.arm() ? std::min(top - 1e-3, robot.X_WB().translation().z()) : top - kDeep_m;
  Block table;
  table.X_LC.translation() << config.p_WO.head<2>(), 0.5 * (top + bottom);
  table.half << config.cell.table_half_m, 0.5 * (top - bottom);
  return table;
}

template <typename Solid>
void TakeNearest(const Solid& solid, const TriangleScene& object, double& nearest) {
  if (const auto distance = FindDistance(solid, object, nearest)) nearest = *distance;
}

/// How near a part comes to the object, if nearer than `enough_m`; otherwise that.
double CalcObjectDistance(const PlacedPart& part, const TriangleScene& object, double enough_m) {
  double nearest = enough_m;
  for (const Capsule& capsule : part.capsules_W) TakeNearest(capsule, object, nearest);
  for (const Block& block : part.blocks_W) TakeNearest(block, object, nearest);
  const auto inside = [&](const Eigen::Vector3d& p_W) { return object.IsInside(p_W); };
  if (std::ranges::any_of(part.capsules_W, [&](const Capsule& c) { return inside(c.p_A); }) ||
      std::ranges::any_of(part.blocks_W, [&](const Block& b) { return inside(b.X_LC.translation()); }))
    nearest = std::min(nearest, 0.0);
  return nearest;
}

bool TouchesTable(const PlacedPart& part, const Block& table) {
  const auto touches = [&](const auto& solid) { return CalcBlockDistance(solid, table) <= 0.0; };
  return std::ranges::any_of(part.capsules_W, touches) || std::ranges::any_of(part.blocks_W, touches);
}

bool TouchesFloor(const PlacedPart& part, double floor_z_m) {
  const auto touches = [&](const auto& solid) { return CalcLowest(solid) <= floor_z_m; };
  return std::ranges::any_of(part.capsules_W, touches) || std::ranges::any_of(part.blocks_W, touches);
}

}  // namespace

struct MotionAuditor::World {
  World(const TriangleMesh& object_W, const RunConfig& run)
      : config(run), object(object_W), robot(run), error(PoseError::Make(run)), table(MakeTable(run, robot)) {}

  Posture MakePosture(int64_t utime_us, const Pose& X_WF, const std::vector<double>& joints_rad, bool scanning) const {
    if (!robot.arm()) return {utime_us, X_WF, {}, scanning};
    return robot.MakePosture(utime_us, MakeJoints(joints_rad), scanning);
  }

  /// States and points of a motion in the order of time; where both lie at one instant the state comes first.
  std::vector<Posture> Merge(const ExecutedMotion& motion) const {
    std::vector<Posture> postures;
    for (const RobotState& state : motion.states)
      postures.push_back(MakePosture(state.utime_us, state.X_WF, state.joints_rad, state.scanning));
    if (!motion.done || motion.states.empty()) return postures;
    const int64_t start_us = motion.states.front().utime_us;
    for (const TrajectoryPoint& point : motion.trajectory.points)
      postures.push_back(MakePosture(start_us + point.time_us, point.X_WF, point.joints_rad, point.scanning));
    std::ranges::stable_sort(postures, {}, &Posture::utime_us);
    return postures;
  }

  /// Where an arm stands before its first motion.
  std::optional<Posture> MakeStart(int64_t utime_us) const {
    if (!robot.arm()) return std::nullopt;
    return MakePosture(utime_us, Pose::Identity(), config.cell.arm->start_rad, false);
  }

  RunConfig config;
  TriangleScene object;
  RobotBody robot;
  PoseError error;
  std::optional<Block> table;
};

std::string_view ToString(MotionFault fault) {
  constexpr std::array<std::string_view, kMotionFaults> kNames = {
      "contact_object", "contact_table", "contact_floor", "contact_self", "joint_limit", "speed", "jump"};
  return kNames.at(static_cast<size_t>(fault));
}

int64_t MotionAudit::CountAll() const {
  int64_t sum = 0;
  for (const MotionFaultCount& fault : faults) sum += fault.count;
  return sum;
}

MotionAuditor::MotionAuditor(const TriangleMesh& object_W, const RunConfig& config)
    : world_(std::make_unique<World>(object_W, config)) {
  audit_.nearest_m = kAuditReach_m;
}
MotionAuditor::~MotionAuditor() = default;
MotionAuditor::MotionAuditor(MotionAuditor&&) noexcept = default;

void MotionAuditor::Count(MotionFault fault, const MotionPlace& place) {
  MotionFaultCount& counted = audit_.faults[static_cast<size_t>(fault)];
  if (counted.count++ == 0) counted.first = place;
}

void MotionAuditor::LookAtState(const Posture& posture, int32_t scan) {
  const World& world = *world_;
  const Eigen::Vector3d off_W =
      world.error.CalcTruePose(posture.X_WF, posture.utime_us).translation() - posture.X_WF.translation();
  const int64_t before = audit_.CountAll();
  const auto place = [&](const std::string& body) { return MotionPlace{scan, posture.utime_us, body}; };
  for (const PlacedPart& part : world.robot.Place(posture, off_W)) {
    const double distance = CalcObjectDistance(part, world.object, std::max(audit_.nearest_m, 1e-9));
    if (distance <= 0.0) Count(MotionFault::kContactObject, place(part.name));
    if (distance < audit_.nearest_m) {
      audit_.nearest_m = distance;
      audit_.nearest = place(part.name);
    }
    if (world.table && TouchesTable(part, *world.table)) Count(MotionFault::kContactTable, place(part.name));
    if (world.robot.arm() && part.link > 0 && TouchesFloor(part, world.robot.X_WB().translation().z()))
      Count(MotionFault::kContactFloor, place(part.name));
  }
  if (const auto names = world.robot.FindSelfContact(posture)) Count(MotionFault::kContactSelf, place(*names));
  ++audit_.states;
  audit_.contacts += audit_.CountAll() > before ? 1 : 0;
}

void MotionAuditor::LookAtStretch(const Posture& from, const Posture& to, int32_t scan) {
  const World& world = *world_;
  const double duration_s = 1e-6 * static_cast<double>(to.utime_us - from.utime_us);
  (from.scanning && to.scanning ? audit_.scan_s : audit_.move_s) += duration_s;
  if (const auto fault = FindRateFault(world.robot, world.config.cell, from, to))
    Count(fault->kind, {scan, to.utime_us, fault->body});
  const int pieces = std::max(1, static_cast<int>(std::ceil(world.robot.CalcTravel(from, to) / kStep_m)));
  for (int k = 1; k <= pieces; ++k)
    LookAtState(world.robot.Interpolate(from, to, static_cast<double>(k) / pieces), scan);
}

void MotionAuditor::Look(const ExecutedMotion& motion) {
  const World& world = *world_;
  for (const Posture& posture : world.Merge(motion)) {
    if (!last_) last_ = world.MakeStart(posture.utime_us);
    if (const auto joint = FindJointFault(world.robot, posture))
      Count(MotionFault::kJointLimit, {motion.trajectory.scan, posture.utime_us, *joint});
    if (last_) {
      LookAtStretch(*last_, posture, motion.trajectory.scan);
    } else {
      LookAtState(posture, motion.trajectory.scan);
    }
    last_ = posture;
  }
}

}  // namespace nbs
