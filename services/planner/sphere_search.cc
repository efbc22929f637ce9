#include "services/planner/sphere_search.h"

#include <cmath>
#include <stdexcept>

#include "common/geometry/directions.h"
#include "services/planner/candidate_path.h"

namespace nbs {

std::vector<Candidate> FindSphereCandidates(const Eigen::AlignedBox3d& object_box_W, int scan,
                                            const SphereSearchSettings& settings) {
  if (object_box_W.isEmpty() || settings.viewpoints < 1) {
    throw std::invalid_argument("FindSphereCandidates: an empty box, or no viewpoint");
  }
  const double radius_m = 0.5 * object_box_W.diagonal().norm() + settings.clearance_m;
  std::vector<Candidate> candidates;
  for (const Eigen::Vector3d& out_W : MakeSphereDirections(settings.viewpoints)) {
    const Eigen::Vector3d up_W = std::abs(out_W.z()) < 0.95 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d along_W = (up_W - out_W * out_W.dot(up_W)).normalized();
    const double extent_m = CalcExtent(object_box_W, along_W);
    const Strip strip{object_box_W.center(), out_W, along_W, extent_m};
    candidates.push_back({.source = CandidateSource::kSphere,
                          .born_scan = scan,
                          .rank = static_cast<int32_t>(candidates.size()),
                          .path = MakeStripPath(strip, {}, radius_m, {.min_m = extent_m, .max_m = extent_m})});
  }
  return candidates;
}

}  // namespace nbs
