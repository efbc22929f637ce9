#include "services/planner/motion_planning/motion_planner.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "common/runtime/error.h"
#include "common/runtime/parallel.h"
#include "services/planner/motion_planning/arm_motion.h"
#include "services/planner/motion_planning/free_motion.h"

namespace nbs {
namespace {

std::unique_ptr<const MotionBackend> MakeBackend(const RunConfig& config, const MotionSettings& settings) {
  if (config.cell.robot == "free") return std::make_unique<FreeMotion>(config, settings);
  if (config.cell.robot == "arm") return std::make_unique<ArmMotion>(config, settings);
  throw std::invalid_argument("MotionPlanner: no motion planning for the robot `" + config.cell.robot + "`");
}

void CheckRigid(const Pose& X) {
  if (!IsRigid(X)) throw std::invalid_argument("MotionPlanner: a pose is not rigid");
}

}  // namespace

MotionPlanner::MotionPlanner(const RunConfig& config, const MotionSettings& settings)
    : cell_(config.cell.name), backend_(MakeBackend(config, settings)) {}
MotionPlanner::~MotionPlanner() = default;
MotionPlanner::MotionPlanner(MotionPlanner&&) noexcept = default;
MotionPlanner& MotionPlanner::operator=(MotionPlanner&&) noexcept = default;

PathCheck MotionPlanner::CheckPath(const Clearance& clearance, const ScanPath& path) const {
  CheckRigid(path.X_WS_start);
  CheckRigid(path.X_WS_end);
  return backend_->CheckPath(clearance, path);
}

bool MotionPlanner::ChecksSlowly() const { return backend_->ChecksSlowly(); }

std::vector<PathCheck> MotionPlanner::CheckPaths(const Clearance& clearance, std::span<const ScanPath> paths,
                                                 int threads) const {
  std::vector<PathCheck> checks(paths.size());
  for (const ScanPath& path : paths) {
    CheckRigid(path.X_WS_start);
    CheckRigid(path.X_WS_end);
  }
  ForEachIndex(paths.size(), ChecksSlowly() ? threads : 1,
               [&](size_t i) { checks[i] = backend_->CheckPath(clearance, paths[i]); });
  return checks;
}

RobotPosture MotionPlanner::MakeStartPosture(const ScanPath& first_path) const {
  return backend_->MakeStartPosture(first_path);
}

void MotionPlanner::CheckStart(const Clearance& clearance, const ScanPath& first_path) const {
  const std::string fault = backend_->FindStartFault(clearance, first_path);
  if (!fault.empty()) throw ConfigError("In the cell " + cell_ + ", " + fault + ".");
}

MotionPlanner::Result MotionPlanner::Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                                          uint64_t seed) const {
  CheckRigid(now.X_WS);
  CheckRigid(path.X_WS_start);
  CheckRigid(path.X_WS_end);
  Result result = backend_->Plan(clearance, now, path, seed);
  if (result.trajectory.points.size() > CalcMostPoints(now.joints_rad.size())) return {Verdict::kNoMotion, path, {}};
  return result;
}

}  // namespace nbs
