#include "services/mesher/surface_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace nbs {
namespace {

using Vector6 = Eigen::Matrix<float, 6, 1>;
using Matrix6 = Eigen::Matrix<float, 6, 6>;

constexpr float kMillimetre = 1e3f;  // Fits are made in millimetres, where all terms are near 1.

float CalcKernel(float squared_distance, float squared_radius) {
  const float s = 1.0f - squared_distance / squared_radius;
  return s > 0.0f ? s * s : 0.0f;
}

/// Right-handed frame with the normal as its third axis; columns in W.
Eigen::Matrix3f MakeFrame(const Eigen::Vector3f& normal_W) {
  Eigen::Matrix3f R;
  R.col(0) = normal_W.unitOrthogonal();
  R.col(1) = normal_W.cross(R.col(0));
  R.col(2) = normal_W;
  return R;
}

/// Four samples side by side. The operators work on each.
using Lanes [[gnu::vector_size(16)]] = float;

float CalcTotal(Lanes v) { return (v[0] + v[1]) + (v[2] + v[3]); }

Lanes CalcKernel(Lanes squared_distance, float inverse_squared_radius) {
  const Lanes s = 1.0f - squared_distance * inverse_squared_radius;
  return s > 0.0f ? s * s : Lanes{};
}

/// The surface z = q0 x^2 + q1 xy + q2 y^2 + q3 x + q4 y + q5 over a frame at the anchor.
struct Quadric {
  Eigen::Matrix3f R_WL;
  Vector6 q;

  Lanes CalcHeight(Lanes x, Lanes y) const { return (q[0] * x + q[1] * y + q[3]) * x + (q[2] * y + q[4]) * y + q[5]; }
  /// The larger of the principal curvatures where the slope is small, 1/mm, without its sign.
  float CalcCurvature() const { return std::abs(q[0] + q[2]) + std::hypot(q[0] - q[2], q[1]); }
  Eigen::Vector3f CalcNormal_L() const { return Eigen::Vector3f(-q[3], -q[4], 1.0f).normalized(); }
};

/// Sums over the samples of one weighted pass. The normal matrix of a quadric holds only the 15 moments of x and y up
/// to the fourth order.
struct Pass {
  std::array<float, 15> m{};  // 1 x y xx xy yy xxx xxy xyy yyy xxxx xxxy xxyy xyyy yyyy
  Vector6 right_side = Vector6::Zero();
  float near_weight = 0.0f;
  int measurements = 0;

  /// Smallest standard deviation of the samples across the surface, millimetres.
  float CalcSpread() const {
    const float mean_x = m[1] / m[0], mean_y = m[2] / m[0];
    const float xx = m[3] / m[0] - mean_x * mean_x, xy = m[4] / m[0] - mean_x * mean_y,
                yy = m[5] / m[0] - mean_y * mean_y;
    const float half_trace = 0.5f * (xx + yy);
    const float root = std::sqrt(std::max(0.0f, half_trace * half_trace - (xx * yy - xy * xy)));
    return std::sqrt(std::max(0.0f, half_trace - root));
  }

  Vector6 Solve(float max_curvature_per_m) const {
    Matrix6 A;
    A << m[10], m[11], m[12], m[6], m[7], m[3],  //
        m[11], m[12], m[13], m[7], m[8], m[4],   //
        m[12], m[13], m[14], m[8], m[9], m[5],   //
        m[6], m[7], m[8], m[3], m[4], m[1],      //
        m[7], m[8], m[9], m[4], m[5], m[2],      //
        m[3], m[4], m[5], m[1], m[2], m[0];
    const float prior = 0.5f * max_curvature_per_m / kMillimetre;
    for (int i = 0; i < 3; ++i) A(i, i) += 1.0f / (prior * prior);
    for (int i = 0; i < 6; ++i) A(i, i) += 1e-4f;
    return A.llt().solve(right_side);
  }
};

/// The sums of a pass, by lane.
struct LanePass {
  std::array<Lanes, 15> m{};
  std::array<Lanes, 6> right_side{};
  Lanes near_weight{}, measurements{};

  void Add(Lanes x, Lanes y, Lanes z, Lanes w) {
    const Lanes wx = w * x, wy = w * y, wxx = wx * x, wxy = wx * y, wyy = wy * y;
    const Lanes xx = x * x, xy = x * y, yy = y * y, wz = w * z;
    m[0] += w;
    m[1] += wx;
    m[2] += wy;
    m[3] += wxx;
    m[4] += wxy;
    m[5] += wyy;
    m[6] += wxx * x;
    m[7] += wxx * y;
    m[8] += wyy * x;
    m[9] += wyy * y;
    m[10] += wxx * xx;
    m[11] += wxx * xy;
    m[12] += wxx * yy;
    m[13] += wyy * xy;
    m[14] += wyy * yy;
    right_side[0] += wz * xx;
    right_side[1] += wz * xy;
    right_side[2] += wz * yy;
    right_side[3] += wz * x;
    right_side[4] += wz * y;
    right_side[5] += wz;
  }

  Pass CalcTotals() const {
    Pass pass;
    for (size_t i = 0; i < m.size(); ++i) pass.m[i] = CalcTotal(m[i]);
    for (size_t i = 0; i < right_side.size(); ++i) pass.right_side[static_cast<int>(i)] = CalcTotal(right_side[i]);
    pass.near_weight = CalcTotal(near_weight);
    pass.measurements = static_cast<int>(CalcTotal(measurements));
    return pass;
  }
};

/// Up to four samples, in the frame of a fit; those that are missing weigh nothing.
struct FourSamples {
  std::array<Lanes, 3> p_L{};  // Millimetres.
  Lanes cosine{}, weight{}, measurements{};

  FourSamples(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W, const Eigen::Matrix3f& R_WL) {
    std::array<Lanes, 3> d_W{}, view_W{};
    for (size_t k = 0; k < samples.size(); ++k) {
      const Sample& s = samples[k];
      for (int i = 0; i < 3; ++i) {
        d_W[i][k] = s.p_W[i];
        view_W[i][k] = s.view_W[i];
      }
      weight[k] = s.weight;
      measurements[k] = static_cast<float>(s.measurements);
    }
    for (int i = 0; i < 3; ++i) d_W[i] = kMillimetre * (d_W[i] - anchor_W[i]);
    for (int i = 0; i < 3; ++i) p_L[i] = R_WL(0, i) * d_W[0] + R_WL(1, i) * d_W[1] + R_WL(2, i) * d_W[2];
    cosine = R_WL(0, 2) * view_W[0] + R_WL(1, 2) * view_W[1] + R_WL(2, 2) * view_W[2];
  }
};

Pass MakePass(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W, const Quadric& surface,
              const SurfaceFitSettings& settings) {
  const float radius = kMillimetre * settings.radius_m, tolerance = kMillimetre * settings.height_tolerance_m;
  const float inverse_squared_radius = 1.0f / (radius * radius);
  const float inverse_squared_tolerance = 1.0f / (tolerance * tolerance);
  LanePass pass;
  for (; !samples.empty(); samples = samples.subspan(std::min<size_t>(4, samples.size()))) {
    const FourSamples s(samples.first(std::min<size_t>(4, samples.size())), anchor_W, surface.R_WL);
    const auto& [x, y, z] = s.p_L;
    const Lanes squared_distance = x * x + y * y + z * z;
    const Lanes residual = z - surface.CalcHeight(x, y);
    const Lanes cosine = s.cosine > 0.0f ? s.cosine : Lanes{};
    const Lanes w = cosine * s.weight * CalcKernel(squared_distance, inverse_squared_radius) *
                    CalcKernel(residual * residual, inverse_squared_tolerance);
    pass.Add(x, y, z, w);
    pass.near_weight += squared_distance < 0.25f * radius * radius ? w : Lanes{};
    pass.measurements += w > 0.0f ? s.measurements : Lanes{};
  }
  return pass.CalcTotals();
}

}  // namespace

std::optional<Eigen::Vector3f> EstimateNormal(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W,
                                              const Eigen::Vector3f& side_W, const SurfaceFitSettings& settings) {
  const float squared_radius = settings.radius_m * settings.radius_m;
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Matrix3f second = Eigen::Matrix3f::Zero();
  float weight = 0.0f;
  int measurements = 0;
  for (const Sample& s : samples) {
    const Eigen::Vector3f d = s.p_W - anchor_W;
    const float w = s.weight * CalcKernel(d.squaredNorm(), squared_radius);
    if (w <= 0.0f) continue;
    const Eigen::Vector3f d_mm = kMillimetre * d;
    weight += w;
    first += w * d_mm;
    second += w * d_mm * d_mm.transpose();
    measurements += s.measurements;
  }
  if (measurements < settings.min_measurements) return std::nullopt;
  const Eigen::Vector3f mean = first / weight;
  const Eigen::Matrix3f C = second / weight - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(C);
  const float least_spread = 0.5f * kMillimetre * settings.min_spread_m;
  if (!(solver.eigenvalues()[1] > least_spread * least_spread)) return std::nullopt;
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).normalized();
  return normal.dot(side_W) < 0.0f ? Eigen::Vector3f(-normal) : normal;
}

std::optional<SurfaceFit> FitSurface(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W,
                                     const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                                     const SurfaceFitSettings& settings) {
  Quadric surface{MakeFrame(normal_W), Vector6::Zero()};
  surface.q[5] = kMillimetre * normal_W.dot(p_W - anchor_W);
  Pass pass;
  constexpr int kMostPasses = 4;
  for (int i = 0; i < kMostPasses; ++i) {
    pass = MakePass(samples, anchor_W, surface, settings);
    if (pass.measurements < settings.min_measurements || pass.CalcSpread() < kMillimetre * settings.min_spread_m)
      return std::nullopt;
    const Vector6 before = surface.q;
    surface.q = pass.Solve(settings.max_curvature_per_m);
    const Eigen::Vector3f normal_L = surface.CalcNormal_L();
    // A frame that the surface has turned away from is a bad measure of height: turn it after. Done when neither frame
    // nor weights would change much.
    constexpr float kTurned = 0.97f, kMoved_mm = 0.3f;
    const bool turned = normal_L.z() < kTurned;
    if (!turned && std::abs(surface.q[5] - before[5]) < kMoved_mm) break;
    if (!turned || i + 1 == kMostPasses) continue;
    surface.R_WL = MakeFrame((surface.R_WL * normal_L).normalized());
    surface.q << 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, surface.q[5] * normal_L.z();
  }
  const float height = surface.q[5] / kMillimetre;
  if (!(std::abs(height) <= settings.height_tolerance_m)) return std::nullopt;
  return SurfaceFit{anchor_W + surface.R_WL.col(2) * height, (surface.R_WL * surface.CalcNormal_L()).normalized(),
                    pass.measurements, pass.near_weight / pass.m[0], kMillimetre * surface.CalcCurvature()};
}

}  // namespace nbs
