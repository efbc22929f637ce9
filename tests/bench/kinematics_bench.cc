/// Time of inverse and forward kinematics and of the arm's own collision check, on the KR 16 over random poses.

#include <benchmark/benchmark.h>

#include "common/kinematics/arm_body.h"
#include "common/kinematics/inverse_kinematics.h"
#include "tests/common/kinematics/arms.h"

namespace nbs {
namespace {

constexpr int kPoses = 10000;

std::vector<Joints> MakeJointValues(const ArmModel& model) {
  std::vector<Joints> values;
  for (int i = 0; i < kPoses; ++i) values.push_back(MakeRandomJoints(model, 1, i));
  return values;
}

void BM_InverseKinematics(benchmark::State& state, IkMethod method) {
  const ArmModel model = ReadKr16();
  const InverseKinematics ik(model, method);
  std::vector<Pose> poses_BF;
  for (const Joints& q : MakeJointValues(model)) poses_BF.push_back(CalcFlangePose(model, q));
  size_t k = 0;
  size_t solutions = 0;
  for (auto _ : state) solutions += ik.FindAll(poses_BF[k++ % kPoses]).size();
  state.counters["solutions"] = static_cast<double>(solutions) / static_cast<double>(k);
}
BENCHMARK_CAPTURE(BM_InverseKinematics, analytic, IkMethod::kAnalytic)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_InverseKinematics, numeric, IkMethod::kNumeric)->Unit(benchmark::kMicrosecond);

void BM_ForwardKinematics(benchmark::State& state) {
  const ArmModel model = ReadKr16();
  const std::vector<Joints> values = MakeJointValues(model);
  size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(CalcFlangePose(model, values[k++ % kPoses]));
}
BENCHMARK(BM_ForwardKinematics)->Unit(benchmark::kMicrosecond);

void BM_SelfDistance(benchmark::State& state) {
  const ArmModel model = ReadKr16();
  const ArmBody body(model, {{{0, 0, 0.1}, {0, 0, 0.1}, 0.06}});
  const std::vector<Joints> values = MakeJointValues(model);
  LinkPoses X_BL;
  size_t k = 0;
  for (auto _ : state) {
    CalcLinkPoses(model, values[k++ % kPoses], X_BL);
    benchmark::DoNotOptimize(body.CalcSelfDistance(X_BL, 0.05));
  }
}
BENCHMARK(BM_SelfDistance)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace nbs

BENCHMARK_MAIN();
