#pragma once

#include <cstdint>
#include <vector>

#include "common/mapping/voxel_grid.h"
#include "common/sensing/profiler.h"

namespace nbs {

/// Weights of the inverse sensor model.
struct InverseSensorModelSettings {
  double hit_nat = 8.0;   ///< Log-likelihood quotient of a return in a cell: more than min to occupied, so that one
                          ///< clear hit occludes at once.
  double miss_nat = 2.0;  ///< The same of a pass, taken off.
  double min_probability = 0.007;  ///< Clamps: a cell never gets surer than this.
  double max_probability = 0.993;
  double free_margin_sigma = 3.0;  ///< k: a beam with range z frees up to z - k sigma(z).
  bool spare_occupied = true;      ///< An occupied cell takes passes more slowly (MapUpdate); false: as any other.
};

/// The model's weights as log-odds in 1/1024 nat.
struct LogOddsSteps {
  int16_t hit = 0;
  int16_t miss = 0;
  int16_t lowest = 0;
  int16_t highest = 0;
};

/// @throws ConfigError if a weight is not positive and below 16 nats, the clamps are not in 0 < min < 0.5 < max < 1, a
/// single hit on a cell that is known to be free
///         does not make it occupied, or the highest probability is not occupied.
LogOddsSteps MakeLogOddsSteps(const InverseSensorModelSettings& settings);

/// Straight lines that are proven clear from a viewpoint (emitter or camera) up to the cell before each end.
struct FreeFan {
  Eigen::Vector3d p_WA;
  std::vector<Eigen::Vector3d> ends_W;  ///< One per return.
};

/// What one stripe proves.
struct StripeEvidence {
  std::vector<Eigen::Vector3d> hits_W;  ///< Points of the surface, one per return.
  std::vector<FreeFan> fans;            ///< The emitter's and, if there is one, the camera's.
};

/// The geometry of a stripe after the inverse sensor model (section III-C): per beam with range z a point at z and a
/// clear line from the emitter to z - k sigma(z); with a camera (baseline > 0) the line from the camera to the same
/// distance before the point as well. Behind the point nothing is known. A beam without a return (range 0) or with a
/// depth outside the depth of field by more than 1 mm proves nothing: the object may stand nearer than the depth of
/// field.
///
/// @param directions_S  CalcBeamDirections_S of the profiler.
/// @param memory  An evidence that is no longer needed; its memory is used again.
/// @pre  stripe.ranges_m has one entry per direction, or none.
StripeEvidence CalcStripeEvidence(const Profiler& profiler, const std::vector<Eigen::Vector3d>& directions_S,
                                  double free_margin_sigma, const Stripe& stripe, StripeEvidence memory = {});

}  // namespace nbs
