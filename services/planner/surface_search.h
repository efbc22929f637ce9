#pragma once

#include <functional>
#include <vector>

#include "services/planner/candidate_path.h"
#include "services/planner/surface_view.h"

namespace nbs {

struct SurfaceSearchSettings {
  PathLimits limits;
  double seed_spacing_m = 0.04;  ///< Between the places for which paths are proposed, where the surface faces alike.
  double patch_radius_m = 0.10;  ///< Of the surface around a seed over which a path is laid.
  double short_m = 0.20;         ///< Paths over the patch …
  double long_m = 0.60;          ///< … and over what goes on beside it.
  int improve = 12;              ///< So many of the best proposals, unlike each other, are improved, …
  int rounds = 6;                ///< … in so many rounds of small moves.
  size_t max_candidates = 300;   ///< The best that are not alike.
  double alike_m = 0.02;         ///< Candidates nearer than this and …
  double alike_rad = 0.12;       ///< … turned by less than this are one.
  uint32_t seed_step = 16;       ///< Proposals are ranked by every so many elements of the prediction, …
  uint32_t element_step = kRankingStep;  ///< … and improved by every so many.
  int threads = 2;
  std::function<bool(const ScanPath&)> could_drive;  ///< Other paths are not proposed; empty: all could be driven.
};

/// Proposes scan paths over the predicted surface (the boundary search of section III-A with the prediction in the
/// place of the quadratic patch).
///
/// Seeds are spread over the elements. Around each the path runs along the first or second principal axis of the patch,
/// looks along its mean normal and keeps the working stand-off; where the robot could not be, it looks from aside. A
/// sensor with a camera sees otherwise when it is rolled by half a turn: then both rolls are proposed. The
/// best proposals are then improved: shifted, turned, lengthened, moved nearer or away, as long as the gain grows. All
/// that come near the best stay candidates, because the robot may not reach the best.
///
/// @returns Unlike paths by falling gain, as every `element_step`-th element tells it; of equals the earlier proposal
///          first.
std::vector<ScanPath> FindSurfacePaths(const SurfacePrediction& prediction, const SurfaceView& view,
                                       const Profiler& profiler, double voxel_m,
                                       const SurfaceSearchSettings& settings = {});

}  // namespace nbs
