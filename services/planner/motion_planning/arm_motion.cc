#include "services/planner/motion_planning/arm_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/config/cell_arm.h"
#include "common/runtime/error.h"
#include "services/planner/motion_planning/joint_search.h"

namespace nbs {
namespace {

ArmSetup MakeSetup(const RunConfig& config) {
  const ArmConfig& arm = config.cell.arm.value();
  const ArmModel model = ReadCellArm(config.cell);
  const bool analytic = arm.inverse_kinematics == "analytic";
  if (analytic) {
    if (const auto obstacle = SphericalWristIk::FindObstacle(model))
      throw ConfigError(arm.urdf.string() + ": the arm " + *obstacle +
                        "; set `inverse_kinematics: numeric` in the cell.");
  }
  return {InverseKinematics(model, analytic ? IkMethod::kAnalytic : IkMethod::kNumeric), ArmCollision(config, model),
          config.cell.X_FS, config.cell.profiler.scan_speed_m_per_s};
}

ArmTimingLimits MakeArmLimits(const CellConfig& cell, const ArmModel& model) {
  ArmTimingLimits limits;
  for (const ArmJoint& joint : model.joints) limits.rad_per_s.push_back(joint.max_rad_per_s);
  limits.rad_per_s2 = cell.arm->max_rad_per_s2;
  limits.flange = MakeLimits(cell);
  limits.X_FS = cell.X_FS;
  return limits;
}

std::string Explain(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoInverseKinematics:
      return "it is out of the arm's reach";
    case Verdict::kJointLimit:
      return "only beyond the limits of the joints would the arm reach it";
    case Verdict::kSpeed:
      return "a joint would have to jump on it, or to turn or gather speed faster than it can";
    case Verdict::kSelfCollision:
      return "the arm would touch itself, the table or the floor";
    case Verdict::kBlockedByUnknown:
      return "it comes too near to the box that is unknown";
    case Verdict::kNoMotion:
      return "no way to it was found that is free";
    default:
      return std::string(ToString(verdict));
  }
}

}  // namespace

ArmMotion::ArmMotion(const RunConfig& config, const MotionSettings& settings)
    : settings_(settings),
      search_(config.cell.arm.value().motion_search == "prm" ? SearchAlgorithm::kPrm : SearchAlgorithm::kRrtConnect),
      arm_(MakeSetup(config)),
      limits_(MakeArmLimits(config.cell, arm_.ik.model())),
      q_start_(MakeJoints(config.cell.arm->start_rad)) {
  reach_.min_part_m = settings.min_part_m;
  reach_.half_turns = !config.cell.profiler.HasCamera();
}

PathCheck ArmMotion::CheckPath(const Clearance& clearance, const ScanPath& path) const {
  return CheckArmPath(arm_, clearance, path, reach_);
}

/// At the rolls that are tried first (arm_reach.h).
bool ArmMotion::CouldDrive(const Clearance& clearance, const ScanPath& path) const {
  const NothingSolid nothing;
  const auto could_be_at = [&](const Clearance& space, const Pose& X_WS) {
    return std::ranges::any_of(arm_.ik.FindAll(arm_.collision.X_WB().inverse() * X_WS * arm_.X_FS.inverse()),
                               [&](const Joints& q) { return arm_.collision.FindTouch(space, q) == ArmTouch::kFree; });
  };
  const auto could_follow = [&](const ScanPath& roll) {
    return could_be_at(clearance, Interpolate(roll.X_WS_start, roll.X_WS_end, 0.5)) &&
           could_be_at(nothing, roll.X_WS_start) && could_be_at(nothing, roll.X_WS_end);
  };
  return could_follow(path) || (reach_.half_turns && could_follow(RollPath(path)));
}

RobotPosture ArmMotion::MakeStartPosture(const ScanPath&) const {
  const Pose X_WF = arm_.collision.X_WB() * CalcFlangePose(arm_.ik.model(), q_start_);
  return {X_WF * arm_.X_FS, {q_start_.begin(), q_start_.end()}};
}

std::string ArmMotion::FindStartFault(const Clearance& clearance, const ScanPath& first_path) const {
  if (!IsWithinLimits(arm_.ik.model(), q_start_)) return "the arm starts beyond the limits of its joints";
  switch (arm_.collision.FindTouch(clearance, q_start_)) {
    case ArmTouch::kSelf:
      return "the arm starts in collision with itself, the table or the floor";
    case ArmTouch::kOccupied:
    case ArmTouch::kUnknown:
      return "the arm starts inside the box that is unknown, or too near to it";
    case ArmTouch::kFree:
      break;
  }
  return FindPathFault(clearance, first_path);
}

std::string ArmMotion::FindPathFault(const Clearance& clearance, const ScanPath& first_path) const {
  constexpr double kLeastShare = 0.5;
  const std::string remedy = ": move the arm's base (X_OB) or the path (first_view_W, first_standoff_m)";
  const auto plan = [&](const ScanPath& path) { return Plan(clearance, MakeStartPosture(path), path, 0); };
  MotionResult first = plan(first_path);
  if (!first.found() && !reach_.half_turns) first = plan(RollPath(first_path));
  if (!first.found()) return "the first scan path cannot be driven, " + Explain(first.verdict) + remedy;
  if (first.path.length_m() >= kLeastShare * first_path.length_m()) return {};
  return fmt::format("only {:.2f} m of the first scan path of {:.2f} m can be driven{}", first.path.length_m(),
                     first_path.length_m(), remedy);
}

MotionResult ArmMotion::Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                             uint64_t seed) const {
  const ArmReach reach = FindArmReach(arm_, clearance, path, reach_);
  if (reach.drives.empty()) return {reach.verdict, path, {}};
  const Joints q_now = MakeJoints(now.joints_rad);
  const std::optional<Joints> q_from = FindEscape(clearance, q_now);
  if (!q_from) return {Verdict::kNoMotion, path, {}};
  // Only the longest part competes, so that what was rated is what is driven.
  std::vector<ArmDrive> drives;
  for (const ArmDrive& drive : reach.drives) {
    if (drive.path.length_m() > reach.drives.front().path.length_m() - 1e-3) drives.push_back(drive);
  }
  const auto time_of = [&](const ArmDrive& drive) {
    return CalcJointTime(arm_.ik.model(), limits_, *q_from, drive.q.front());
  };
  std::vector<std::pair<double, size_t>> order;
  for (size_t k = 0; k < drives.size(); ++k) order.emplace_back(time_of(drives[k]), k);
  std::sort(order.begin(), order.end());
  std::vector<ArmDrive> sorted;
  for (const auto& [time_s, k] : order) sorted.push_back(drives[k]);

  size_t chosen = 0;
  std::vector<Joints> way = FindWay(clearance, *q_from, sorted, seed, chosen);
  if (way.empty()) return {Verdict::kNoMotion, path, {}};
  way.insert(way.begin(), q_now);
  const ArmDrive& drive = sorted[chosen];
  Trajectory trajectory =
      MakeArmTrajectory(arm_.ik.model(), arm_.collision.X_WB(), limits_, way, drive.q, drive.path.length_m());
  if (CalcAccelerationShare(trajectory, limits_.rad_per_s2) > kMostAccelerationShare)
    return {Verdict::kSpeed, path, {}};
  return {reach.verdict, drive.path, std::move(trajectory)};
}

std::vector<Joints> ArmMotion::FindWay(const Clearance& clearance, const Joints& q_from,
                                       const std::vector<ArmDrive>& drives, uint64_t seed, size_t& drive) const {
  for (drive = 0; drive < drives.size(); ++drive) {
    if (arm_.collision.IsFreeMotion(clearance, q_from, drives[drive].q.front()))
      return {q_from, drives[drive].q.front()};
  }
  const ArmModel& model = arm_.ik.model();
  JointSearchSettings search;
  search.algorithm = search_;
  search.iterations = settings_.joint_search_iterations;
  search.shortcuts = settings_.shortcuts;
  search.seed = seed;
  for (int k = 0; k < model.n(); ++k)
    search.metres_per_rad.push_back(
        arm_.collision.body().CalcReach(static_cast<int>(arm_.collision.body().parts().size()) - 1, k));
  std::vector<Joints> goals;
  for (const ArmDrive& goal : drives) {
    if (goals.size() < static_cast<size_t>(settings_.search_goals)) goals.push_back(goal.q.front());
  }
  JointWay way = FindJointWay(
      model, q_from, goals, search, [&](const Joints& q) { return arm_.collision.IsFree(clearance, q); },
      [&](const Joints& from, const Joints& to) { return arm_.collision.IsFreeMotion(clearance, from, to); });
  drive = way.goal;
  return way.q;
}

/// Off from where the map now says that the arm stands too near: a short motion of the sensor on which it comes no
/// nearer than it stands.
std::optional<Joints> ArmMotion::FindEscape(const Clearance& clearance, const Joints& q_now) const {
  const std::optional<double> squeeze_m = arm_.collision.FindSqueeze(clearance, q_now);
  if (!squeeze_m) return std::nullopt;
  if (*squeeze_m == 0.0) return q_now;
  const Pose X_BF = CalcFlangePose(arm_.ik.model(), q_now);
  const Pose X_BS = X_BF * arm_.X_FS;
  std::vector<Eigen::Vector3d> directions_B;
  for (const auto& direction_S : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, -1), Eigen::Vector3d(-1, 0, -1),
                                  Eigen::Vector3d(0, 1, -1), Eigen::Vector3d(0, -1, -1)})
    directions_B.push_back(X_BS.linear() * direction_S.normalized());
  directions_B.emplace_back(Eigen::Vector3d::UnitZ());
  const std::vector<Joints> near = {q_now};
  for (const double distance_m : {0.02, 0.05, 0.1, 0.2}) {
    for (const Eigen::Vector3d& direction_B : directions_B) {
      Pose X_BF_away = X_BF;
      X_BF_away.translation() += distance_m * direction_B;
      for (const Joints& q : arm_.ik.FindAll(X_BF_away, near)) {
        constexpr double kSmall_rad = 0.5;
        if ((q - q_now).cwiseAbs().maxCoeff() > kSmall_rad) continue;
        if (arm_.collision.IsFree(clearance, q) && arm_.collision.IsFreeMotion(clearance, q_now, q, *squeeze_m))
          return q;
      }
    }
  }
  return std::nullopt;
}

}  // namespace nbs
