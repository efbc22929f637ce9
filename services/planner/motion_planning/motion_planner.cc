#include "services/planner/motion_planning/motion_planner.h"

#include <stdexcept>
#include <string>

#include "services/planner/motion_planning/free_motion.h"

namespace nbs {
namespace {

std::unique_ptr<const MotionBackend> MakeBackend(const RunConfig& config, const MotionSettings& settings) {
  if (config.cell.robot == "free") return std::make_unique<FreeMotion>(config, settings);
  throw std::invalid_argument("MotionPlanner: no motion planning for the robot `" + config.cell.robot + "`");
}

void CheckRigid(const Pose& X) {
  if (!IsRigid(X)) throw std::invalid_argument("MotionPlanner: a pose is not rigid");
}

}  // namespace

MotionPlanner::MotionPlanner(const RunConfig& config, const MotionSettings& settings)
    : backend_(MakeBackend(config, settings)) {}
MotionPlanner::~MotionPlanner() = default;
MotionPlanner::MotionPlanner(MotionPlanner&&) noexcept = default;
MotionPlanner& MotionPlanner::operator=(MotionPlanner&&) noexcept = default;

PathCheck MotionPlanner::CheckPath(const Clearance& clearance, const ScanPath& path) const {
  CheckRigid(path.X_WS_start);
  CheckRigid(path.X_WS_end);
  return backend_->CheckPath(clearance, path);
}

MotionPlanner::Result MotionPlanner::Plan(const Clearance& clearance, const Pose& X_WS_now, const ScanPath& path,
                                          uint64_t seed) const {
  CheckRigid(X_WS_now);
  CheckRigid(path.X_WS_start);
  CheckRigid(path.X_WS_end);
  return backend_->Plan(clearance, X_WS_now, path, seed);
}

}  // namespace nbs
