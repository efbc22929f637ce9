#include "services/planner/quadratic_patch.h"

#include <Eigen/Dense>
#include <cmath>

namespace nbs {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector6d CalcMonomials(double x, double y) { return (Vector6d() << x * x, x * y, y * y, x, y, 1.0).finished(); }

/// Mean, and the covariance seen along z.
struct Spread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double larger = 0.0;  // eigenvalues, m²
  double smaller = 0.0;
};

Spread CalcSpread(const Eigen::Matrix3Xd& points_P) {
  Spread spread;
  spread.mean = points_P.rowwise().mean();
  const Eigen::Matrix2Xd centred = (points_P.colwise() - spread.mean).topRows<2>();
  const Eigen::Matrix2d covariance = centred * centred.transpose() / static_cast<double>(points_P.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance, Eigen::EigenvaluesOnly);
  spread.smaller = std::max(0.0, solver.eigenvalues()(0));
  spread.larger = solver.eigenvalues()(1);
  return spread;
}

/// Weight of the prior per squared coefficient, where x and y are measured in units of `scale` metres. A curvature k is
/// a coefficient of k/2 in 1/m.
double CalcPriorWeight(const QuadraticPatchSettings& settings, double scale) {
  const double sigma = 0.5 * settings.curvature_prior_per_m * scale * scale;
  return settings.noise_m > 0.0 && sigma > 0.0 ? std::pow(settings.noise_m / sigma, 2) : 0.0;
}

}  // namespace

double QuadraticPatch::CalcHeight(double x, double y) const { return coefficients.dot(CalcMonomials(x, y)); }

Eigen::Vector3d QuadraticPatch::CalcNormal_P(double x, double y) const {
  const double slope_x = 2.0 * coefficients(0) * x + coefficients(1) * y + coefficients(3);
  const double slope_y = coefficients(1) * x + 2.0 * coefficients(2) * y + coefficients(4);
  return Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
}

double QuadraticPatch::CalcCurvatureAlongX(double x, double y) const {
  const double slope = 2.0 * coefficients(0) * x + coefficients(1) * y + coefficients(3);
  return 2.0 * coefficients(0) / std::pow(1.0 + slope * slope, 1.5);
}

std::optional<QuadraticPatch> FitQuadraticPatch(const Pose& X_WP, std::span<const Eigen::Vector3d> points_W,
                                                const QuadraticPatchSettings& settings) {
  if (points_W.empty() || static_cast<int>(points_W.size()) < settings.min_points) return std::nullopt;
  Eigen::Matrix3Xd points_P(3, points_W.size());
  const Pose X_PW = X_WP.inverse();
  for (size_t i = 0; i < points_W.size(); ++i) points_P.col(i) = X_PW * points_W[i];
  const Spread spread = CalcSpread(points_P);
  if (!(spread.larger > 0.0) || spread.smaller < settings.min_condition * spread.larger) return std::nullopt;

  const double scale = std::sqrt(spread.larger);  // monomials of order one keep the normal equations well conditioned
  Matrix6d information = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  for (Eigen::Index i = 0; i < points_P.cols(); ++i) {
    const Vector6d m = CalcMonomials(points_P(0, i) / scale, points_P(1, i) / scale);
    information += m * m.transpose();
    right += m * points_P(2, i);
  }
  information.diagonal().head<3>().array() += CalcPriorWeight(settings, scale);
  const Eigen::CompleteOrthogonalDecomposition<Matrix6d> solver(information);
  QuadraticPatch patch;
  patch.X_WP = X_WP;
  patch.points = static_cast<int>(points_W.size());
  patch.coefficients = solver.solve(right);
  patch.coefficients.head<3>() /= scale * scale;
  patch.coefficients.segment<2>(3) /= scale;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < points_P.cols(); ++i) {
    squares += std::pow(points_P(2, i) - patch.CalcHeight(points_P(0, i), points_P(1, i)), 2);
  }
  patch.rms_m = std::sqrt(squares / patch.points);
  return patch;
}

}  // namespace nbs
