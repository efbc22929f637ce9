#pragma once

#include <vector>

#include "services/planner/boundary_search.h"

namespace nbs {

struct HoleDetectionSettings {
  int min_edges = 8;                   ///< Shorter loops are pin-holes.
  int max_edges = 250;                 ///< Longer loops are rims.
  double min_rim_m = 0.05;             ///< Longer lines that are no holes are looked at piece by piece.
  double max_disagreement_rad = 0.70;  ///< Between mean border normal and plane fit; beyond it the surroundings are not
                                       ///< simple and the plane counts.
  double overhang_m = 0.02;            ///< A path is longer than its hole by this at either end.
  int max_holes = 80;                  ///< Only the largest get paths of their own.
  std::vector<double> tilts_rad = {
      0.0, 0.52, -0.52, 0.96,
      -0.96};  ///< About the path and about the stripe, one at a time; the look that failed was often straight.
  double combine_distance_m = 0.12;  ///< Centres nearer than this and …
  double combine_angle_rad = 0.70;   ///< … normals that differ by less give one combined path.
  double alike_m = 0.02;
  double alike_rad = 0.12;
  BoundarySearchSettings rims;  ///< For the pieces of rims; also limits of the paths.
};

/// A closed loop of border edges, seen as a hole in the surface.
struct Hole {
  size_t line = 0;  ///< Number of the loop in BoundarySurface::lines().
  size_t edges = 0;
  double length_m = 0.0;
  double area_m2 = 0.0;                                ///< Of the loop projected along its normal.
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();  ///< Barycentre of the loop.
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< Unit, outward.
};

/// Measures one closed loop.
///
/// The normal is the mean of the border normals (Loriot et al. 2008). Where it is weak or differs from the plane fit
/// (the loop's area vector) by more than the limit, the surroundings are not simple, as around the standing surface of
/// a statue, and the plane fit is taken instead.
///
/// @pre the line is closed.
Hole MakeHole(const BoundarySurface& surface, size_t line, const HoleDetectionSettings& settings = {});

/// Closed loops within the limits on edges (section III-B of the paper), the largest area first, ties by number of the
/// line.
std::vector<Hole> FindHoles(const BoundarySurface& surface, const HoleDetectionSettings& settings = {});

/// The strip over some holes: through the middle of their extents, along the first principal axis of their loops in the
/// plane of the mean normal (weighted with area), as long as they are, with overhang.
Strip MakeHoleStrip(const BoundarySurface& surface, const std::vector<Hole>& holes, double overhang_m);

/// Groups of two or more holes with similar centre and orientation: for every hole, in order, itself and all that are
/// similar to it; a group that comes twice is listed once. Numbers in `holes`, ascending.
std::vector<std::vector<size_t>> FindSimilarHoles(const std::vector<Hole>& holes,
                                                  const HoleDetectionSettings& settings = {});

/// Proposes scan paths over all holes of the mesh (section III-B of the paper).
///
/// Single holes, groups of similar holes, and what is left over: a line above the upper limit on edges gives a path as
/// a whole if it is closed, and the paths of a boundary for each of its pieces. Each comes straight on and tilted, with
/// its own extent and over the object's whole extent. `rank` counts from 0 in the order proposed, `id` is left 0. The
/// paper detects holes once; the caller decides.
///
/// @param born_scan  The newest scan, for the record.
std::vector<Candidate> FindHoleCandidates(const BoundarySurface& surface, int born_scan, const Profiler& profiler,
                                          const HoleDetectionSettings& settings = {});

}  // namespace nbs
