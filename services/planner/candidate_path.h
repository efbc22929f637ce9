#pragma once

#include <span>
#include <vector>

#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"

namespace nbs {

/// Shortest and longest scan path that is proposed, metres.
struct PathLimits {
  double min_m = 0.03;
  double max_m = 0.70;
};

/// A strip of surface to be looked at.
struct Strip {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();        ///< Middle of the strip, metres.
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< Outward, any length but 0.
  Eigen::Vector3d along_W =
      Eigen::Vector3d::UnitX();  ///< The path's direction, any length but 0, not parallel to the normal.
  double extent_m = 0.0;         ///< Along `along_W`, centred at the middle.
};

/// How a strip is looked at, apart from straight on. Angles in radians, right-handed, applied to the view about axes
/// that stay in the strip.
struct Tilt {
  double about_along_rad = 0.0;   ///< About the path: looks at the strip from its side.
  double about_across_rad = 0.0;  ///< About the stripe: looks ahead or back along the path.
};

/// The scan path parallel to `along_W` (made perpendicular to the normal) whose stripe lies across it and whose view
/// meets the middle of the strip at the stand-off. Straight on the view is minus the normal. The extent is clamped to
/// the limits.
///
/// @throws std::invalid_argument if the normal or the direction has no length, or they are parallel.
ScanPath MakeStripPath(const Strip& strip, const Tilt& tilt, double standoff_m, const PathLimits& limits);

/// Half the width of a stripe at the working stand-off on a surface that faces the sensor, metres.
double CalcHalfWidth(const Profiler& profiler);

/// The extent of a box along a unit direction, metres.
double CalcExtent(const Eigen::AlignedBox3d& box_W, const Eigen::Vector3d& direction_W);

/// The same strip grown along its path to the extent of the object (box) in that direction and moved so that it lies
/// over the object.
Strip ExtendToBox(const Strip& strip, const Eigen::AlignedBox3d& box_W, double overhang_m, const PathLimits& limits);

/// True if two candidates would see nearly the same: the middles closer than `distance_m`, orientations within
/// `angle_rad` (a path driven backwards counts as the same), lengths within a quarter of the longer.
bool AreAlike(const ScanPath& a, const ScanPath& b, double distance_m, double angle_rad);

/// Removes every candidate that is like an earlier one, keeping the order.
void RemoveAlike(std::vector<Candidate>& candidates, double distance_m, double angle_rad);

}  // namespace nbs
