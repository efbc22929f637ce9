#pragma once

#include <cstdint>
#include <vector>

#include "common/planning/scan_path.h"
#include "services/planner/boundary_surface.h"

namespace nbs {

/// Where the missing neighbour lies, in the sensor frame of the scan that made the boundary: left is -x (along the
/// stripe), bottom is -y (against the scan direction). The order is that of the B method.
enum class BoundaryClass : uint8_t { kLeft = 0, kRight = 1, kTop = 2, kBottom = 3 };

/// An ordered piece of a border with one class and without sharp turn: a boundary of section III-A.
struct BoundaryChain {
  BoundaryClass boundary_class = BoundaryClass::kLeft;
  std::vector<uint32_t> vertices;  ///< v1 … vm, the surface on the left seen from outside.
  double length_m = 0.0;
  Eigen::Vector3d outward_W = Eigen::Vector3d::Zero();  ///< Unit: mean direction out of the surface, in the surface.
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();   ///< Unit: mean of the border triangles' normals.
};

struct BoundaryChainSettings {
  double min_length_m = 0.015;  ///< Shorter ones are noise.
  double max_length_m = 0.30;   ///< Longer ones are cut in equal pieces.
  double smoothing_m = 0.010;  ///< Directions are means over this length of border to either side: single edges zigzag.
  double max_turn_rad =
      1.05;  ///< A chain ends where the border turns by more than this against the chain's mean direction.
  double gap_m =
      0.012;  ///< Border within this of a vertex of the newest scan, along the line, belongs to the newest scan.
};

/// Cuts the border that the newest scan left into boundaries (section III-A of the paper; Kriegel et al., ICRA 2011,
/// section III).
///
/// Takes the vertices whose last scan is `scan`. Ordered by class, then by position in the scan's view: left and right
/// by y, top and bottom by x, ties by lowest vertex.
///
/// @param path  Of the scan, with poses of the sensor in W.
std::vector<BoundaryChain> FindBoundaryChains(const BoundarySurface& surface, int scan, const ScanPath& path,
                                              const BoundaryChainSettings& settings = {});

/// Cuts one line into boundaries by turn and length alone, for rims that are left over from any scan. All get the class
/// kLeft.
std::vector<BoundaryChain> CutRim(const BoundarySurface& surface, const BorderLine& line,
                                  const BoundaryChainSettings& settings = {});

}  // namespace nbs
