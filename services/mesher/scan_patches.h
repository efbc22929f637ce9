#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/sensing/profiler.h"

namespace nbs {

/// A small piece of surface as a single scan saw it.
struct ScanPatch {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();       ///< Mean of the measurements in its cell, metres.
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< Unit, towards the side that was seen.
  int32_t scan = 0;
  double along = 0.0;  ///< When its scan saw it: -1 at the first stripe, 1 at the last.
};

struct ScanPatchSettings {
  double cell_m = 0.004;        ///< One patch a cell and scan at most.
  int min_measurements = 12;    ///< In the cell and those around it; fewer: no patch.
  double min_spread_m = 0.001;  ///< Least standard deviation across the narrower direction: no normal from one stripe.
  double max_thickness = 0.1;   ///< Variance along the normal, at most this share of that across.
  double least_view_cosine =
      0.4;  ///< Between the normal and the way to the sensor: what is seen more obliquely is noise.
};

/// Where in its scan a stripe lies: -1 at the first, 1 at the last, 0 if there is only one.
///
/// @param last_index  Number of the scan's last stripe.
double CalcAlong(const Stripe& stripe, int32_t last_index);

/// Number of the last stripe of each scan, the closing one aside, by scan; -1: none.
///
/// @throws std::invalid_argument if a stripe's scan is below 0 or 10,000 and more.
std::vector<int32_t> FindLastIndices(std::span<const Stripe> stripes);

/// Cuts each scan into patches, scan by scan and cell by cell in a fixed order. A patch lies where the measurements of
/// its cell lie in the mean, not on the plane through its surroundings: stripes see what faces them with more points
/// than what is oblique, which would draw the plane towards the sensor (0.2 mm in the registration of the statue).
///
/// @param stripes  Those that are not measurable (stripe_check.h) are passed over as the mesher does, and so are ranges
///                 that are not finite, not above 0 or beyond twice the depth of field.
std::vector<ScanPatch> MakeScanPatches(const Profiler& profiler, std::span<const Stripe> stripes,
                                       const ScanPatchSettings& settings = {});

}  // namespace nbs
