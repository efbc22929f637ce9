#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/mesher/scan_patches.h"

namespace nbs {

struct ScanRegistrationSettings {
  int rounds = 8;          ///< Pairs are found anew in each.
  double reach_m = 0.005;  ///< A patch is compared with the nearest one of each other scan, no farther off than this,
  double max_aside_m = 0.003;  ///< nor than this along the surface,
  double least_cosine = 0.8;   ///< if their normals make an angle with at least this cosine.
  // Pairs farther apart than the tolerance, along the normal, have no weight (Tukey). It shrinks from round to round.
  double first_tolerance_m = 0.004;
  double tolerance_shrinks = 0.75;
  double last_tolerance_m = 0.0015;
  // The prior: being moved costs as much as so many pairs that are as far apart. What no pairs tell stays as reported.
  double middle_prior = 5.0;
  double slope_prior = 20.0;
};

/// By what the stripes of a scan are to be moved: a translation that changes evenly along the scan. Metres in W.
struct ScanCorrection {
  Eigen::Vector3d middle_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d slope_W = Eigen::Vector3d::Zero();

  /// @param along  -1 at the scan's first stripe, 1 at its last.
  Eigen::Vector3d CalcOffset(double along) const { return middle_W + along * slope_W; }
};

/// Registers all scans with each other, for a robot that is off by a translation which changes slowly: at once, not one
/// after the other, so that no scan's error is handed on.
///
/// Least squares over the point-to-plane distances of pairs of patches of different scans, linear in the corrections,
/// solved in rounds with pairs found and weighted anew (after Neugebauer, "Reconstruction of real-world objects via
/// simultaneous registration and robust combination of multiple range images", Int. J. of Shape Modeling 3 (1997),
/// DOI 10.1142/S0218654397000069, and Pulli, "Multiview registration for large data sets", 3DIM 1999, DOI
/// 10.1109/IM.1999.805346; here with translations only). Pairs tell nothing about an offset that all scans have in
/// common, nor about a direction in which the surface slides along itself: both stay at zero, and the middles of the
/// corrections add up to zero.
///
/// @param patches  Of scans 0 to scan_count - 1.
/// @returns One correction a scan; the same patches give the same bits.
/// @throws std::invalid_argument if a patch's scan is not below scan_count.
std::vector<ScanCorrection> RegisterScans(std::span<const ScanPatch> patches, int scan_count,
                                          const ScanRegistrationSettings& settings = {});

/// The stripes as they were reported, with those of each scan moved by what RegisterScans finds for it.
std::vector<Stripe> MakeRegisteredStripes(const Profiler& profiler, std::vector<Stripe> stripes);

}  // namespace nbs
