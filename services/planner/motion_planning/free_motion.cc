#include "services/planner/motion_planning/free_motion.h"

#include <algorithm>
#include <optional>

#include "services/planner/motion_planning/escape.h"
#include "services/planner/motion_planning/flange_path.h"
#include "services/planner/motion_planning/reach.h"
#include "services/planner/motion_planning/se3_search.h"
#include "services/planner/motion_planning/swept_check.h"

namespace nbs {
namespace {

constexpr double kSameTime = 1e-6;    // seconds
constexpr double kSameLength = 1e-3;  // metres

CollisionBody MakeBody(const CellConfig& cell) {
  return {MoveSpheres(cell.X_FS, cell.sensor_body_S), cell.body_margin_m};
}

Eigen::AlignedBox3d MakeSearchBox(const GridShape& grid, double margin_m) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(margin_m);
  const Eigen::Vector3d top_W = grid.origin_W + grid.resolution_m * grid.size.cast<double>();
  return {grid.origin_W - margin, top_W + margin};
}

}  // namespace

FreeMotion::FreeMotion(const RunConfig& config, const MotionSettings& settings)
    : settings_(settings),
      X_FS_(config.cell.X_FS),
      table_z_m_(config.cell.table_z_m),
      half_turns_(!config.cell.profiler.HasCamera()),
      body_F_(MakeBody(config.cell)),
      limits_(MakeLimits(config.cell)),
      search_box_W_(MakeSearchBox(config.grid, settings.search_margin_m)) {}

PathCheck FreeMotion::CheckPath(const Clearance& clearance, const ScanPath& path) const {
  const auto check = [&](const Clearance& all) {
    const Reach reach = FindReach(body_F_, X_FS_, all, path, settings_.min_part_m, half_turns_);
    return PathCheck{reach.verdict, reach.paths.empty() ? path : reach.paths.front()};
  };
  return table_z_m_ ? check(AboveTable(clearance, *table_z_m_)) : check(clearance);
}

MotionResult FreeMotion::Plan(const Clearance& clearance, const RobotPosture& now, const ScanPath& path,
                              uint64_t seed) const {
  if (table_z_m_) return PlanAbove(AboveTable(clearance, *table_z_m_), now.X_WS, path, seed);
  return PlanAbove(clearance, now.X_WS, path, seed);
}

MotionResult FreeMotion::PlanAbove(const Clearance& clearance, const Pose& X_WS_now, const ScanPath& path,
                                   uint64_t seed) const {
  const Reach reach = FindReach(body_F_, X_FS_, clearance, path, settings_.min_part_m, half_turns_);
  if (reach.paths.empty()) return {reach.verdict, path, {}};
  const Pose X_WF_now = X_WS_now * X_FS_.inverse();
  const std::optional<Pose> X_WF_from = FindEscape(body_F_, clearance, X_WF_now, X_WS_now.linear());
  if (!X_WF_from) return {Verdict::kNoMotion, path, {}};

  const std::vector<Drive> drives = MakeDrives(reach.paths, *X_WF_from);
  for (const Drive& drive : drives) {
    if (!IsFreeMotion(body_F_, clearance, *X_WF_from, drive.poses_WF.front())) continue;
    return MakeResult(reach.verdict, {X_WF_now, *X_WF_from, drive.poses_WF.front()}, drive);
  }
  const size_t searches = std::min(drives.size(), static_cast<size_t>(std::max(0, settings_.searches)));
  for (size_t k = 0; k < searches; ++k) {
    std::vector<Pose> way_WF = FindWay(clearance, *X_WF_from, drives[k].poses_WF.front(), seed);
    if (way_WF.empty()) continue;
    way_WF.insert(way_WF.begin(), X_WF_now);
    return MakeResult(reach.verdict, way_WF, drives[k]);
  }
  return {Verdict::kNoMotion, path, {}};
}

std::vector<FreeMotion::Drive> FreeMotion::MakeDrives(const std::vector<ScanPath>& paths, const Pose& X_WF_from) const {
  struct Rated {
    Drive drive;
    double length_m = 0.0;
    double time_s = 0.0;
  };
  std::vector<Rated> rated;
  for (const ScanPath& path : paths) {
    for (const ScanPath& way : {path, ReversePath(path)}) {
      Drive drive{way, MakeFlangePath(X_FS_, way)};
      const double time_s = CalcMotionTime(limits_, X_WF_from, drive.poses_WF.front());
      rated.push_back({std::move(drive), way.length_m(), time_s});
    }
  }
  // Insertion by rule: a longer part first, then the nearer start; near ties keep their order.
  std::vector<Drive> drives;
  const auto before = [](const Rated& a, const Rated& b) {
    if (std::abs(a.length_m - b.length_m) > kSameLength) return a.length_m > b.length_m;
    return a.time_s < b.time_s - kSameTime;
  };
  while (!rated.empty()) {
    auto best = rated.begin();
    for (auto it = rated.begin(); it != rated.end(); ++it) {
      if (before(*it, *best)) best = it;
    }
    drives.push_back(std::move(best->drive));
    rated.erase(best);
  }
  return drives;
}

std::vector<Pose> FreeMotion::FindWay(const Clearance& clearance, const Pose& X_WF_from, const Pose& X_WF_to,
                                      uint64_t seed) const {
  Se3SearchSettings search;
  search.box_W = search_box_W_;
  search.metres_per_rad = limits_.move_m_per_s / limits_.turn_rad_per_s;
  search.iterations = settings_.search_iterations;
  search.range_m = settings_.search_range_m;
  search.shortcuts = settings_.shortcuts;
  search.seed = seed;
  return FindSe3Path(
      X_WF_from, X_WF_to, search, [&](const Pose& X_WF) { return body_F_.FindTouch(clearance, X_WF) == Touch::kFree; },
      [&](const Pose& from, const Pose& to) { return IsFreeMotion(body_F_, clearance, from, to); });
}

MotionResult FreeMotion::MakeResult(Verdict verdict, const std::vector<Pose>& approach_WF, const Drive& drive) const {
  return {verdict, drive.path, MakeTrajectory(limits_, approach_WF, drive.poses_WF, drive.path.length_m())};
}

}  // namespace nbs
