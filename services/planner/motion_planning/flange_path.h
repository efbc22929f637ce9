#pragma once

#include <vector>

#include "common/planning/scan_path.h"

namespace nbs {

/// A scan path as the flange drives it: poses X_WF = X_WS X_FS^-1 at even fractions of the path, between which the
/// flange moves straight and turns evenly.
///
/// Where the sensor stands off the flange's origin and turns along the path, its origin leaves the straight line
/// between two poses by the rise of an arc; there are so many poses that this stays below 0.1 mm. At least two poses;
/// the first and the last are the path's ends.
std::vector<Pose> MakeFlangePath(const Pose& X_FS, const ScanPath& path);

/// The part of a scan path between two fractions of it.
ScanPath CutPath(const ScanPath& path, double begin, double end);

/// The same line from its end to its start.
ScanPath ReversePath(const ScanPath& path);

}  // namespace nbs
