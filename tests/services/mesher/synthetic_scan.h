#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "common/runtime/counter_random.h"
#include "common/sensing/profiler.h"

namespace nbs {

/// Where a ray meets a solid.
struct SolidHit {
  double distance_m = 0.0;
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
};

/// A solid that rays meet in closed form: origin and unit direction in, first hit out.
using Solid = std::function<std::optional<SolidHit>(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

inline Solid MakeSolidSphere(double radius_m) {
  return [=](const Eigen::Vector3d& o, const Eigen::Vector3d& d) -> std::optional<SolidHit> {
    const double b = o.dot(d), discriminant = b * b - o.squaredNorm() + radius_m * radius_m;
    if (discriminant < 0.0) return std::nullopt;
    const double t = -b - std::sqrt(discriminant);
    if (t <= 0.0) return std::nullopt;
    return SolidHit{t, (o + t * d) / radius_m};
  };
}

/// Axis-parallel box about `centre`, by slabs.
inline Solid MakeSolidBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  return [=](const Eigen::Vector3d& o, const Eigen::Vector3d& d) -> std::optional<SolidHit> {
    double enter = 0.0, leave = std::numeric_limits<double>::max();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const double to_low = centre[i] - half[i] - o[i], to_high = centre[i] + half[i] - o[i];
      if (std::abs(d[i]) < 1e-12) {
        if (to_low > 0.0 || to_high < 0.0) return std::nullopt;
        continue;
      }
      const double near = (d[i] > 0.0 ? to_low : to_high) / d[i], far = (d[i] > 0.0 ? to_high : to_low) / d[i];
      if (near > enter) {
        enter = near;
        normal = Eigen::Vector3d::Unit(i) * (d[i] > 0.0 ? -1.0 : 1.0);
      }
      leave = std::min(leave, far);
    }
    if (enter <= 0.0 || enter > leave) return std::nullopt;
    return SolidHit{enter, normal};
  };
}

inline Solid MakeUnion(const Solid& a, const Solid& b) {
  return [=](const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const auto hit_a = a(o, d), hit_b = b(o, d);
    if (!hit_a || !hit_b) return hit_a ? hit_a : hit_b;
    return hit_a->distance_m <= hit_b->distance_m ? hit_a : hit_b;
  };
}

/// A straight sweep with the stripe across it.
struct Sweep {
  int32_t scan = 0;
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d view_W = Eigen::Vector3d::UnitX();
  Eigen::Vector3d offset_W = Eigen::Vector3d::Zero();  ///< Error of the reported pose.
  double step_m = 0.002;
};

inline std::vector<float> CastStripe(const Solid& solid, const Profiler& profiler, const Pose& X_WS, uint64_t scan,
                                     uint64_t index) {
  std::vector<float> ranges_m;
  for (int i = 0; i < profiler.points; ++i) {
    const Eigen::Vector3d beam_S = CalcBeamDirection_S(profiler, i), beam_W = X_WS.linear() * beam_S;
    const auto hit = solid(X_WS.translation(), beam_W);
    const double depth = hit ? hit->distance_m * beam_S.z() : 0.0;
    const bool returned = hit && depth >= profiler.min_depth_m && depth <= profiler.max_depth_m &&
                          -hit->normal_W.dot(beam_W) >= std::cos(profiler.max_incidence_rad);
    const double noise =
        returned ? CalcRangeSigma(profiler, depth) * CalcGaussian({scan, index, static_cast<uint64_t>(i)}) : 0.0;
    ranges_m.push_back(returned ? static_cast<float>(hit->distance_m + noise) : 0.0f);
  }
  return ranges_m;
}

/// The stripes of a sweep, the closing one included.
///
/// @param take_ranges  take_ranges(X_WS, index): the ranges of one stripe.
template <typename TakeRanges>
std::vector<Stripe> MakeStripes(const Sweep& sweep, TakeRanges&& take_ranges) {
  const Eigen::Vector3d along = sweep.to_W - sweep.from_W;
  const int count = static_cast<int>(std::lround(along.norm() / sweep.step_m)) + 1;
  std::vector<Stripe> stripes;
  for (int i = 0; i <= count; ++i) {
    Stripe stripe;
    stripe.scan = sweep.scan;
    stripe.index = i;
    stripe.utime_us = sweep.scan * 100'000'000LL + i * 40'000LL;
    stripe.end_of_scan = i == count;
    stripe.X_WS = MakeLookPose(sweep.from_W + along.normalized() * (i * sweep.step_m), sweep.view_W, along);
    if (!stripe.end_of_scan) stripe.ranges_m = take_ranges(stripe.X_WS, i);
    stripe.X_WS.translation() += sweep.offset_W;
    stripes.push_back(stripe);
  }
  return stripes;
}

inline std::vector<Stripe> ScanSolid(const Solid& solid, const Profiler& profiler, const Sweep& sweep) {
  return MakeStripes(sweep, [&](const Pose& X_WS, int index) {
    return CastStripe(solid, profiler, X_WS, static_cast<uint64_t>(sweep.scan), static_cast<uint64_t>(index));
  });
}

/// Sweeps along z from `count` sides about the z axis, looking at the axis, then three each from above and from below.
inline std::vector<Sweep> MakeSweepsAround(double reach_m, double standoff_m, int count, double tilt_rad) {
  std::vector<Sweep> sweeps;
  const auto add = [&](const Eigen::Vector3d& view, const Eigen::Vector3d& side, const Eigen::Vector3d& along) {
    const Eigen::Vector3d middle = -(reach_m + standoff_m) * view + side;
    sweeps.push_back({static_cast<int32_t>(sweeps.size()), middle - 1.4 * reach_m * along,
                      middle + 1.4 * reach_m * along, view, Eigen::Vector3d::Zero(), 0.002});
  };
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * M_PI * i / count;
    for (double tilt : {0.0, tilt_rad, -tilt_rad}) {
      add({std::cos(a) * std::cos(tilt), std::sin(a) * std::cos(tilt), -std::sin(tilt)}, Eigen::Vector3d::Zero(),
          Eigen::Vector3d::UnitZ());
    }
  }
  for (double z : {1.0, -1.0}) add({0.0, 0.0, z}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  return sweeps;
}

}  // namespace nbs
