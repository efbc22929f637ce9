/// Time of motion planning per scan path, on a map of the default object's size: half of it scanned, half unknown.

#include <benchmark/benchmark.h>

#include "services/planner/motion_planning/map_clearance.h"
#include "services/planner/motion_planning/motion_planner.h"
#include "tests/services/planner/motion_planning/map_cases.h"
#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr uint64_t kRequests = 200;

/// A scan path of 0.3 m at the working distance of the statue, seen from `angle_rad`.
ScanPath MakePathAtStandoff(double angle_rad) {
  ScanPath path = MakeUpwardPath(angle_rad);
  for (Pose* X : {&path.X_WS_start, &path.X_WS_end}) X->translation().head<2>() *= 0.425 / 0.35;
  return path;
}

void BM_Clearances(benchmark::State& state) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  for (auto _ : state) benchmark::DoNotOptimize(MapClearance(grid));
}
BENCHMARK(BM_Clearances)->Unit(benchmark::kMillisecond);

void BM_CheckPath(benchmark::State& state) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  const MapClearance clearance(grid);
  const MotionPlanner planner(MakeRunAround(grid));
  uint64_t k = 0;
  for (auto _ : state) {
    // Any orientation, within 0.45 m of the middle: free, partly free and blocked.
    const ScanPath path = {MakeRandomPose(1, k % kRequests, 0.45), MakeRandomPose(2, k % kRequests, 0.45)};
    benchmark::DoNotOptimize(planner.CheckPath(clearance, path));
    ++k;
  }
}
BENCHMARK(BM_CheckPath)->Unit(benchmark::kMicrosecond);

/// @param turn  Share of a whole turn about the statue between the current pose and the path: 0.1 is straight, 0.5
/// behind the statue.
void BM_Plan(benchmark::State& state, double turn) {
  const VoxelGrid grid = MakeHalfScannedStatue(0.0);
  const MapClearance clearance(grid);
  const MotionPlanner planner(MakeRunAround(grid));
  uint64_t k = 0;
  int64_t found = 0;
  for (auto _ : state) {
    const double from = kTurn * CalcUniform({k % kRequests, 1});
    const Pose X_now = MakePathAtStandoff(from).X_WS_start;
    found += planner.Plan(clearance, X_now, MakePathAtStandoff(from + kTurn * turn), k % kRequests).found() ? 1 : 0;
    ++k;
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(k);
}
BENCHMARK_CAPTURE(BM_Plan, straight, 0.1)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_Plan, round_the_statue, 0.5)->Unit(benchmark::kMicrosecond);

/// The worst case: a closed shell about the sensor, so that every search runs to its end.
void BM_PlanWithoutAWay(benchmark::State& state) {
  BoxWorld world = MakeBlockWorld();
  const Pose X_now = MakePose({0, 0, 1.0}, Eigen::Quaterniond::Identity());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector3d middle = X_now.translation();
      middle[axis] += side * 0.25;
      Eigen::Vector3d half = Eigen::Vector3d::Constant(0.26);
      half[axis] = 0.01;
      world.occupied.emplace_back(middle - half, middle + half);
    }
  }
  const MotionPlanner planner(MakeFreeRun());
  for (auto _ : state) benchmark::DoNotOptimize(planner.Plan(world, X_now, MakeUpwardPath(0.0), 1));
}
BENCHMARK(BM_PlanWithoutAWay)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace nbs

BENCHMARK_MAIN();
