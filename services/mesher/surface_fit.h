#pragma once

#include <optional>
#include <span>

#include "services/mesher/measurement_map.h"

namespace nbs {

struct SurfaceFitSettings {
  float radius_m = 0.005f;            ///< R_n: samples beyond it have no weight.
  float height_tolerance_m = 0.004f;  ///< Samples further than this from the surface along the normal have no weight:
                                      ///< another sheet, or an outlier.
  int min_measurements = 5;           ///< Fewer within R_n and the tolerance: no fit.
  float min_spread_m = 0.0008f;  ///< Least standard deviation of the samples across the surface, in their narrowest
                                 ///< direction: no normal from one stripe.
  float max_curvature_per_m = 150.0f;  ///< Prior on the quadratic terms: their expected size.
};

/// The surface at a vertex.
struct SurfaceFit {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();       ///< The anchor moved along the normal onto the surface, metres.
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< Unit, towards the side that was seen.
  int measurements = 0;                                ///< That carried it.
  float near_share = 0.0f;  ///< Share of the weight within R_n / 2: 0.58 in the middle and at the rim of a surface that
                            ///< is evenly measured, little at a point in the air beside one.
  float curvature_per_m = 0.0f;  ///< The larger of the principal curvatures, without its sign.
};

/// Normal by weighted principal components of the samples within R_n, turned towards side_W. Nothing if the samples are
/// too few or in a line.
std::optional<Eigen::Vector3f> EstimateNormal(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W,
                                              const Eigen::Vector3f& side_W, const SurfaceFitSettings& settings);

/// Fits z = ax^2 + bxy + cy^2 + dx + ey + f to the samples in a frame at the anchor with z along the normal: a moving
/// least-squares surface (Levin 2003) with Tukey weights in height, so that a few outliers or a sheet behind do not
/// pull, and a prior that keeps the quadratic terms small where there are few samples. Two scans that lie up to the
/// height tolerance apart are averaged by their weights.
///
/// @param samples   Seen from the side of the normal.
/// @param anchor_W  Metres; the vertex keeps its place across the normal.
/// @param p_W       Where the surface is thought to pass along the normal: the vertex so far, or the anchor.
/// @param normal_W  Unit; a first guess, good to some 30 degrees.
/// @returns Nothing if the samples are too few, all in a line, or the surface does not pass the anchor within the
/// tolerance.
std::optional<SurfaceFit> FitSurface(std::span<const Sample> samples, const Eigen::Vector3f& anchor_W,
                                     const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                                     const SurfaceFitSettings& settings);

}  // namespace nbs
