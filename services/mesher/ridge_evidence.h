#pragma once

#include <vector>

#include "services/mesher/measurement_map.h"
#include "services/mesher/roof.h"

namespace nbs {

struct RidgeEvidenceSettings {
  float roof_radius_m = 0.0035f;  ///< Measurements within it of a vertex must lie on its roof,
  float roof_misfit_m = 0.0002f;  ///< up to this (root mean square) and their own error.
  float near_radius_m = 0.002f;   ///< The mean of those within it of a ridge lies below the roof,
  float near_depth_m =
      0.00025f;               ///< since cells mix both sides, but with two standard deviations no further than this.
  float nearest_m = 0.0016f;  ///< The nearest lies no further off a ridge than this,
  float nearest_to_corner_m = 0.0018f;  ///< or a corner.
  float beside_radius_m = 0.0035f;      ///< Within it there are some on either side along the ridge,
  float beside_m = 0.0002f;             ///< at least so far.
};

/// Asks the measurements whether a ridge is there and sharp. A rounded one lies clear below the roof.
class RidgeEvidence {
 public:
  RidgeEvidence(const MeasurementMap& measurements, const RidgeEvidenceSettings& settings)
      : measurements_(measurements), settings_(settings) {}

  /// True if the measurements around a point lie on the roof.
  ///
  /// @param lax  Twice the square is enough: for what was on a ridge before, so that noise does not change the verdict
  /// from scan to scan, and near corners, where a cell mixes three sides.
  bool Carries(const Roof& roof, const Tangent& at, bool lax);

  /// True if a place on the roof was measured: near by, about on the roof, and, on a ridge, on both sides along it.
  bool IsMeasured(const Roof& roof, const Roof::Feature& feature);

 private:
  void Gather(const Tangent& at, float radius_m);

  const MeasurementMap& measurements_;
  RidgeEvidenceSettings settings_;
  std::vector<Sample> samples_;
};

}  // namespace nbs
