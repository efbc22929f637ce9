#include "tests/bench/mesher_runs.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "common/runtime/counter_random.h"

namespace nbs::bench {
namespace {

double CalcHill(double x, double y) { return 0.02 * std::sin(x / 0.08) * std::cos(y / 0.1); }

/// Along the beam, by fixed-point iteration: hills are less steep than beams.
double CalcRangeToHills(const Eigen::Vector3d& p_W, const Eigen::Vector3d& beam_W) {
  double range = p_W.z();
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d q_W = p_W + range * beam_W;
    range = (CalcHill(q_W.x(), q_W.y()) - p_W.z()) / beam_W.z();
  }
  return range;
}

}  // namespace

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

int64_t CountHeapBytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<int64_t>(info.uordblks + info.hblkhd);
}

MesherRun RunMesher(const Profiler& profiler, std::span<const Stripe> stripes, bool keep_replica) {
  RunConfig config;
  config.cell.profiler = profiler;
  MesherRun run;
  run.node = std::make_unique<MesherNode>(config);
  run.stripe_seconds.reserve(stripes.size());
  Outbox out;
  for (const Stripe& stripe : stripes) {
    run.points += std::ranges::count_if(stripe.ranges_m, [](float range) { return range > 0.0f; });
    const Message message = stripe;
    const double begin = CpuSeconds();
    run.node->Handle(message, out);
    run.stripe_seconds.push_back(CpuSeconds() - begin);
    run.seconds += run.stripe_seconds.back();
    if (keep_replica) {
      for (const Message& m : out) {
        if (const auto* delta = std::get_if<MeshDelta>(&m)) run.replica.Apply(*delta);
      }
    }
    out.clear();
  }
  return run;
}

Stripe MakeHillStripe(const Profiler& profiler, int64_t n) {
  constexpr int64_t kStripes = 501;
  constexpr double kStep_m = 0.002, kLane_m = 0.25;
  Stripe stripe;
  stripe.scan = static_cast<int32_t>(n / kStripes);
  stripe.index = static_cast<int32_t>(n % kStripes);
  stripe.utime_us = 40'000 * n;
  stripe.end_of_scan = stripe.index == kStripes - 1;
  const Eigen::Vector3d p_W(kStep_m * stripe.index, kLane_m * stripe.scan, profiler.standoff_m);
  stripe.X_WS = MakeLookPose(p_W, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX());
  if (stripe.end_of_scan) return stripe;
  for (int i = 0; i < profiler.points; ++i) {
    const Eigen::Vector3d beam_S = CalcBeamDirection_S(profiler, i);
    const double range = CalcRangeToHills(p_W, stripe.X_WS.linear() * beam_S);
    const double noise = CalcRangeSigma(profiler, range * beam_S.z()) *
                         CalcGaussian({static_cast<uint64_t>(n), static_cast<uint64_t>(i)});
    stripe.ranges_m.push_back(static_cast<float>(range + noise));
  }
  return stripe;
}

}  // namespace nbs::bench
