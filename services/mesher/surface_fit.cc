#include "services/mesher/surface_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
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

float EvaluateQuadric(const Vector6& q, float x, float y) {
  return q[0] * x * x + q[1] * x * y + q[2] * y * y + q[3] * x + q[4] * y + q[5];
}

/// Sums of one weighted pass over the samples.
struct Pass {
  Matrix6 normal_matrix = Matrix6::Zero();  // Lower triangle.
  Vector6 right_side = Vector6::Zero();
  float weight = 0.0f;
  float squared_residual = 0.0f;
  Eigen::Vector2f first = Eigen::Vector2f::Zero();
  Eigen::Matrix2f second = Eigen::Matrix2f::Zero();
  int measurements = 0;

  void Add(const Eigen::Vector3f& p, float w, float residual, int count) {
    Vector6 row;
    row << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1.0f;
    normal_matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    right_side += (w * p.z()) * row;
    weight += w;
    squared_residual += w * residual * residual;
    first += w * p.head<2>();
    second += w * p.head<2>() * p.head<2>().transpose();
    measurements += count;
  }

  /// Smallest standard deviation of the samples across the surface, millimetres.
  float CalcSpread() const {
    const Eigen::Vector2f mean = first / weight;
    const Eigen::Matrix2f C = second / weight - mean * mean.transpose();
    const float half_trace = 0.5f * C.trace();
    const float root = std::sqrt(std::max(0.0f, half_trace * half_trace - C.determinant()));
    return std::sqrt(std::max(0.0f, half_trace - root));
  }
};

Pass MakePass(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W, const Eigen::Matrix3f& R_WL,
              const Vector6& q, const SurfaceFitSettings& settings) {
  const float squared_radius = settings.radius_m * settings.radius_m * kMillimetre * kMillimetre;
  const float squared_tolerance = settings.height_tolerance_m * settings.height_tolerance_m * kMillimetre * kMillimetre;
  Pass pass;
  for (const Sample& s : samples) {
    if (s.view_sum_W.dot(R_WL.col(2)) <= 0.0f) continue;
    const Eigen::Vector3f p = kMillimetre * (R_WL.transpose() * (s.p_W - anchor_W));
    const float residual = p.z() - EvaluateQuadric(q, p.x(), p.y());
    const float w =
        s.weight * CalcKernel(p.squaredNorm(), squared_radius) * CalcKernel(residual * residual, squared_tolerance);
    if (w > 0.0f) pass.Add(p, w, residual, s.measurements);
  }
  return pass;
}

Vector6 SolvePass(const Pass& pass, const SurfaceFitSettings& settings) {
  Matrix6 A = pass.normal_matrix.selfadjointView<Eigen::Lower>();
  const float prior = 0.5f * settings.max_curvature_per_m / kMillimetre;
  for (int i = 0; i < 3; ++i) A(i, i) += 1.0f / (prior * prior);
  for (int i = 0; i < 6; ++i) A(i, i) += 1e-4f;
  return A.ldlt().solve(pass.right_side);
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
  if (!(solver.eigenvalues()[1] > 0.25f * std::pow(kMillimetre * settings.min_spread_m, 2.0f))) return std::nullopt;
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).normalized();
  return normal.dot(side_W) < 0.0f ? Eigen::Vector3f(-normal) : normal;
}

std::optional<SurfaceFit> FitSurface(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W,
                                     const Eigen::Vector3f& normal_W, const SurfaceFitSettings& settings) {
  Eigen::Matrix3f R_WL = MakeFrame(normal_W);
  Vector6 q = Vector6::Zero();
  Pass pass;
  for (int iteration = 0; iteration < 3; ++iteration) {
    pass = MakePass(samples, anchor_W, R_WL, q, settings);
    if (pass.measurements < settings.min_measurements || pass.CalcSpread() < kMillimetre * settings.min_spread_m)
      return std::nullopt;
    q = SolvePass(pass, settings);
    const Eigen::Vector3f normal_L = Eigen::Vector3f(-q[3], -q[4], 1.0f).normalized();
    constexpr float kTurnedFar =
        0.94f;  // 20 degrees: the frame is too oblique for "height" to mean distance; turn it and start over.
    if (iteration == 2 || normal_L.z() > kTurnedFar) {
      if (iteration > 0) break;
      continue;
    }
    R_WL = MakeFrame((R_WL * normal_L).normalized());
    q = Vector6::Zero();
    q[5] = 0.0f;
  }
  SurfaceFit fit;
  fit.normal_W = (R_WL * Eigen::Vector3f(-q[3], -q[4], 1.0f)).normalized();
  fit.p_W = anchor_W + R_WL.col(2) * (q[5] / kMillimetre);
  fit.residual_m = std::sqrt(pass.squared_residual / pass.weight) / kMillimetre;
  fit.measurements = pass.measurements;
  const float offset = std::abs(q[5]) / kMillimetre;
  if (!std::isfinite(offset) || offset > settings.height_tolerance_m) return std::nullopt;
  return fit;
}

}  // namespace nbs
