#pragma once

#include <vector>

#include "services/planner/boundary_chains.h"
#include "services/planner/candidate_path.h"
#include "services/planner/quadratic_patch.h"

namespace nbs {

struct BoundarySearchSettings {
  BoundaryChainSettings chains;
  QuadraticPatchSettings patch;
  PathLimits limits;
  double band_m = 0.030;  ///< Width of the band of surface along the chain that supports the patch.
  double max_normal_angle_rad =
      1.2;  ///< A vertex whose normal differs more from the chain's does not support the patch.
  double overlap_m =
      0.03;       ///< The outermost candidate's stripe still covers this much of the old data (on a flat surface).
  int steps = 3;  ///< Candidates outward from the border, evenly up to the outermost.
  double max_turn_away_rad = 1.3;  ///< Outward steps end where the estimated surface has turned by this.
  double max_convex_per_m = 25.0;  ///< Curvature outward is clamped to a radius of 40 mm where the surface turns away …
  double max_concave_per_m = 8.0;  ///< … and 125 mm where it turns towards the sensor.
  double overhang_m = 0.02;        ///< A path is longer than its chain by this at either end.
  std::vector<double> tilts_rad = {
      0.0, 0.44, -0.44,
      0.96};  ///< Views turned about the chord; positive: looks back at the surface from beyond the border.
  double min_long_chain_m = 0.05;   ///< From this length a chain also gets paths over the object's whole extent.
  bool one_path_per_chain = false;  ///< Straight on at the middle step over the whole extent; short chains get none.
  double alike_m = 0.02;            ///< Candidates nearer than this and …
  double alike_rad = 0.12;          ///< … turned by less than this are one.
};

/// The surface beyond a boundary as the patch foretells it.
struct EstimatedSurface {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();       ///< Metres.
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< Unit, outward.
  double turned_rad = 0.0;                             ///< Against the surface at the border; positive: away.
};

/// Fits the patch of a chain: x out of the surface, y along the chord v1 → vm, z the mean normal, origin at the chain's
/// mean.
///
/// Falls back to the plane through the border normals where the support does not determine a patch.
/// @returns Nothing if the chord is shorter than a millimetre or parallel to the normal.
std::optional<QuadraticPatch> FitBoundaryPatch(const BoundarySurface& surface, const BoundaryChain& chain,
                                               const BoundarySearchSettings& settings = {});

/// Continues the patch `distance_m` along the surface beyond the border: an arc with the curvature that the patch has
/// there, clamped. A parabola would foretell a surface that never turns away; an arc is exact on cylinders and spheres.
EstimatedSurface Extrapolate(const QuadraticPatch& patch, double distance_m,
                             const BoundarySearchSettings& settings = {});

/// Scan paths beside one chain, best guess first: straight on at the middle step, then the other steps and tilts; each
/// with the chain's own extent and, for longer chains, over the object's whole extent.
std::vector<ScanPath> MakeChainPaths(const BoundarySurface& surface, const BoundaryChain& chain,
                                     const Profiler& profiler, const BoundarySearchSettings& settings = {});

/// Proposes scan paths beside the boundaries of the newest scan (section III-A of the paper; Kriegel et al., ICRA
/// 2011).
///
/// Each candidate looks at the middle of the estimated surface beyond a boundary, along its normal there or tilted
/// about the chord, from the working stand-off; its path runs parallel to the chord and its stripe across it.
/// Candidates that would see nearly the same are proposed once. `rank` counts from 0: the first path of every chain in
/// the order of class and position, then the second paths, and so on. `id` is left 0.
///
/// @param scan  Number of the newest scan: vertices whose last scan it is make its boundaries.
/// @param path  Of that scan, poses of the sensor in W.
std::vector<Candidate> FindBoundaryCandidates(const BoundarySurface& surface, int scan, const ScanPath& path,
                                              const Profiler& profiler, const BoundarySearchSettings& settings = {});

}  // namespace nbs
