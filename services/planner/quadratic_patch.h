#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "common/geometry/pose.h"

namespace nbs {

struct QuadraticPatchSettings {
  double noise_m = 0.0005;              ///< Standard deviation of the points along z, metres; 0: plain least squares.
  double curvature_prior_per_m = 20.0;  ///< Standard deviation of the curvature of surfaces, 1/m (20: radius 50 mm).
  int min_points = 12;
  double min_condition =
      1e-4;  ///< Smallest allowed ratio of the eigenvalues of the points' covariance in the xy-plane.
};

/// The surface z = a x² + b x y + c y² + d x + e y + f in the patch frame P.
struct QuadraticPatch {
  Pose X_WP = Pose::Identity();
  Eigen::Matrix<double, 6, 1> coefficients =
      Eigen::Matrix<double, 6, 1>::Zero();  ///< a … f; a, b, c in 1/m, d and e plain, f in metres.
  double rms_m = 0.0;                       ///< Of the residuals along z.
  int points = 0;

  /// z in P over (x, y), metres.
  double CalcHeight(double x, double y) const;
  /// Unit normal in P over (x, y); its z is positive.
  Eigen::Vector3d CalcNormal_P(double x, double y) const;
  /// Curvature of the section along x where it passes (x, y), 1/m; positive where the surface bends towards +z.
  double CalcCurvatureAlongX(double x, double y) const;
};

/// Fits a quadratic patch by least squares (section III-A of the paper; Kriegel et al., ICRA 2011, section IV).
///
/// The quadratic terms are held near zero by a prior (maximum a posteriori with the two standard deviations of the
/// settings), so that few or noisy points give a plane and many good ones the plain least-squares solution.
///
/// @param X_WP      Patch frame: z about the surface's normal, origin among the points.
/// @param points_W  Metres.
/// @returns Nothing if there are fewer than min_points, or they lie so nearly on a line (seen along z) that the plane
/// itself is not determined.
std::optional<QuadraticPatch> FitQuadraticPatch(const Pose& X_WP, std::span<const Eigen::Vector3d> points_W,
                                                const QuadraticPatchSettings& settings = {});

}  // namespace nbs
