#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/planning/scan_path.h"

namespace nbs {

struct SphereSearchSettings {
  int viewpoints = 121;       ///< As many as Wong, Dumont & Abidi used (section IV-B).
  double clearance_m = 0.15;  ///< The sphere's radius is that of the box around the object and this.
};

/// Proposes scan paths from viewpoints on a sphere around the object (the S methods of section IV-B; Wong, Dumont &
/// Abidi, "Next best view system in a 3-D object modeling task", IEEE CIRA 1999).
///
/// Viewpoints are spread evenly, from the top of the sphere down to its bottom. From each the sensor looks at the
/// middle of the box and sweeps straight over the box's whole extent, upwards where it can. `rank` is the viewpoint's
/// number; `id` is left 0.
///
/// @param object_box_W  Box around the object, metres.
/// @throws std::invalid_argument if the box is empty or there is no viewpoint.
std::vector<Candidate> FindSphereCandidates(const Eigen::AlignedBox3d& object_box_W, int scan,
                                            const SphereSearchSettings& settings = {});

}  // namespace nbs
