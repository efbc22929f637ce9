/// Collision of the KR 16 and its sensor with a map: our check beside FCL's on the same bodies and the same cells as an
/// octree, unknown as occupied.

#include <benchmark/benchmark.h>

#include <chrono>

#include "common/kinematics/inverse_kinematics.h"
#include "services/planner/motion_planning/arm_collision.h"
#include "services/planner/motion_planning/map_clearance.h"
#include "tests/bench/fcl_peer.h"
#include "tests/common/kinematics/arms.h"
#include "tests/services/planner/motion_planning/arm_cases.h"
#include "tests/services/planner/motion_planning/map_cases.h"

namespace nbs::bench {
namespace {

constexpr int kStates = 10000;
constexpr double kFree = 0.3;

/// The half-scanned statue, on the origin.
VoxelGrid MakeMap() {
  const VoxelGrid statue = MakeHalfScannedStatue(0.0);
  GridShape shape = statue.shape();
  shape.origin_W.z() = 0.0;
  VoxelGrid map(shape);
  std::ranges::copy(statue.cells(), map.cells().begin());
  return map;
}

/// Joint values even over the limits; or such that the sensor has any orientation within half a metre of the statue.
std::vector<Joints> MakeStates(const ArmCollision& arm, bool near) {
  const InverseKinematics ik(arm.model(), IkMethod::kAnalytic);
  std::vector<Joints> states;
  for (uint64_t i = 0; static_cast<int>(states.size()) < kStates; ++i) {
    if (!near) {
      states.push_back(MakeRandomJoints(arm.model(), 1, i));
      continue;
    }
    Pose X_WF = MakeRandomPose(2, i, 0.5);
    X_WF.translation().z() += 0.35;
    const std::vector<Joints> found = ik.FindAll(arm.X_WB().inverse() * X_WF);
    if (!found.empty()) states.push_back(found[i % found.size()]);
  }
  return states;
}

double Seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void BM_MapCollision(benchmark::State& state, bool near) {
  const RunConfig config = MakeKr16Run();
  const ArmCollision arm(config, ReadKr16());
  const VoxelGrid map = MakeMap();
  const MapClearance clearance(map);
  const FclPeer fcl(map, Obstacles::kOccupiedOrUnknown, kFree, arm.body(), arm.margin_m());
  const std::vector<Joints> states = MakeStates(arm, near);
  std::vector<bool> ours(states.size());
  std::vector<bool> theirs(states.size());
  double our_s = 0.0;
  double their_s = 0.0;
  for (auto _ : state) {
    // Short turns, so that what else the machine does meets both.
    constexpr size_t kTurn = 500;
    for (size_t begin = 0; begin < states.size(); begin += kTurn) {
      const double before_s = Seconds();
      for (size_t i = begin; i < begin + kTurn; ++i)
        ours[i] = arm.TouchesMap(clearance, Obstacles::kOccupiedOrUnknown, states[i], arm.margin_m());
      const double between_s = Seconds();
      for (size_t i = begin; i < begin + kTurn; ++i) {
        LinkPoses X_BL;
        CalcLinkPoses(arm.model(), states[i], X_BL);
        theirs[i] = fcl.IsTouched(arm.X_WB(), X_BL);
      }
      our_s += between_s - before_s;
      their_s += Seconds() - between_s;
    }
  }
  int64_t touched = 0;
  int64_t other = 0;
  for (size_t i = 0; i < states.size(); ++i) {
    touched += theirs[i] ? 1 : 0;
    other += ours[i] != theirs[i] ? 1 : 0;
  }
  const auto checks = static_cast<double>(states.size()) * static_cast<double>(state.iterations());
  state.counters["touched"] = static_cast<double>(touched);
  state.counters["other_verdicts"] = static_cast<double>(other);
  state.counters["checks_per_s"] = checks / our_s;
  state.counters["fcl_checks_per_s"] = checks / their_s;
  state.counters["ratio_to_fcl"] = their_s / our_s;
}
BENCHMARK_CAPTURE(BM_MapCollision, near_the_object, true)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(BM_MapCollision, anywhere, false)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace nbs::bench

BENCHMARK_MAIN();
