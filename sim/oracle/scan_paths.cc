#include "sim/oracle/scan_paths.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "common/runtime/counter_random.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr uint64_t kPathKey = 0x6f7261636c65;  // "oracle"
constexpr double kNear_m = 0.0005;
/// One free path in so many draws is found on every object that can be scanned at all.
constexpr int kMaxDraws = 10000;

/// Uniform draws under the keys of one path and one try.
class Draws {
 public:
  Draws(uint64_t seed, uint64_t path, uint64_t draw) : seed_(seed), path_(path), draw_(draw) {}
  double Next(double low, double high) {
    return low + (high - low) * CalcUniform({kPathKey, seed_, path_, draw_, number_++});
  }

 private:
  uint64_t seed_, path_, draw_;
  uint64_t number_ = 0;
};

/// A unit vector across `direction`, turned by `roll_rad`.
Vector3d MakeAcross(const Vector3d& direction, double roll_rad) {
  const Vector3d a = direction.unitOrthogonal();
  return std::cos(roll_rad) * a + std::sin(roll_rad) * direction.cross(a);
}

ScanPath DrawPath(std::span<const SurfaceSample> samples, const OraclePathSettings& settings, Draws draws) {
  const auto count = static_cast<double>(samples.size());
  const SurfaceSample& sample = samples[std::min(static_cast<size_t>(draws.Next(0.0, count)), samples.size() - 1)];
  const double cosine = draws.Next(std::cos(settings.max_tilt_rad), 1.0);
  const double turn_rad = draws.Next(0.0, 2.0 * std::numbers::pi);
  const Vector3d out_W =
      cosine * sample.normal_W + std::sqrt(1.0 - cosine * cosine) * MakeAcross(sample.normal_W, turn_rad);
  const Vector3d middle_W = sample.p_W + draws.Next(settings.min_standoff_m, settings.max_standoff_m) * out_W;
  const Vector3d along_W = MakeAcross(out_W, draws.Next(0.0, 2.0 * std::numbers::pi));
  const Vector3d half_W = 0.5 * draws.Next(settings.min_length_m, settings.max_length_m) * along_W;
  return {MakeLookPose(middle_W - half_W, -out_W, along_W), MakeLookPose(middle_W + half_W, -out_W, along_W)};
}

bool SphereKeepsClear(const TriangleScene& object_W, const ScanPath& path, const Sphere& sphere, double clearance_m) {
  const Vector3d p_WA = path.X_WS_start * sphere.center, p_WB = path.X_WS_end * sphere.center;
  const double length = (p_WB - p_WA).norm();
  const double needed = sphere.radius_m + clearance_m;
  // A point of the way that is d from the object has a free way of d - needed on both sides.
  double done = 0.0;
  while (true) {
    const Vector3d p_W = length > 0.0 ? Vector3d(p_WA + done / length * (p_WB - p_WA)) : p_WA;
    const auto closest = object_W.FindClosest(p_W, needed + length);
    if (!closest) return true;
    if (closest->distance_m < needed + kNear_m) return false;
    if (done >= length) return true;
    done = std::min(length, done + closest->distance_m - needed);
  }
}

}  // namespace

bool KeepsClear(const TriangleScene& object_W, const ScanPath& path, const OracleBody& body, double clearance_m) {
  return std::all_of(body.spheres_S.begin(), body.spheres_S.end(), [&](const Sphere& sphere) {
    const double lowest = std::min((path.X_WS_start * sphere.center).z(), (path.X_WS_end * sphere.center).z());
    if (body.table_z_m && lowest - sphere.radius_m - clearance_m < *body.table_z_m) return false;
    return SphereKeepsClear(object_W, path, sphere, clearance_m);
  });
}

std::vector<ScanPath> MakeRandomScanPaths(const TriangleScene& object_W, std::span<const SurfaceSample> samples,
                                          const OracleBody& body, const OraclePathSettings& settings) {
  if (samples.empty()) throw std::invalid_argument("MakeRandomScanPaths: no samples");
  std::vector<ScanPath> paths;
  paths.reserve(std::max(settings.count, 0));
  for (int i = 0; i < settings.count; ++i) {
    int draw = 0;
    ScanPath path;
    do {
      if (draw == kMaxDraws) {
        throw std::invalid_argument("MakeRandomScanPaths: no path is free among " + std::to_string(kMaxDraws));
      }
      path = DrawPath(samples, settings, {settings.seed, static_cast<uint64_t>(i), static_cast<uint64_t>(draw++)});
    } while (!KeepsClear(object_W, path, body, settings.clearance_m));
    paths.push_back(path);
  }
  return paths;
}

}  // namespace nbs
