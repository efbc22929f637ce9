#include "services/voxelmap/map_update.h"

#include <algorithm>

namespace nbs {

MapUpdate::MapUpdate(const GridShape& shape, const Profiler& profiler, const InverseSensorModelSettings& settings)
    : profiler_(profiler),
      settings_(settings),
      steps_(MakeLogOddsSteps(settings)),
      directions_S_(CalcBeamDirections_S(profiler)),
      grid_(shape),
      changes_(shape.cells()),
      touched_(shape.cells(), 0),
      judged_(shape.cells(), 0) {}

void MapUpdate::Insert(const Stripe& stripe) {
  BeginStripe();
  const StripeEvidence evidence = CalcStripeEvidence(profiler_, directions_S_, settings_.free_margin_sigma, stripe);
  const uint16_t scan = static_cast<uint16_t>(stripe.scan + 1);
  for (const Eigen::Vector3d& p_W : evidence.hits_W) {
    const int64_t index = FindCell(grid_.shape(), p_W);
    if (index >= 0) ApplyHit(index, scan);
  }
  for (const FreeRay& free_ray : evidence.free_rays) {
    RayWalk ray = MakeRayWalk(grid_.shape(), free_ray.p_WA, free_ray.p_WB);
    // The last cell is that of z - k sigma, unless the walk was cut at the box before it.
    if (FindCell(grid_.shape(), free_ray.p_WB) >= 0) --ray.steps;
    WalkRay(ray, [&](int64_t index) {
      ApplyPass(index, scan);
      return true;
    });
  }
}

void MapUpdate::BeginStripe() {
  if (++stripe_stamp_ != 0) return;
  std::fill(touched_.begin(), touched_.end(), uint16_t{0});
  stripe_stamp_ = 1;
}

void MapUpdate::ApplyHit(int64_t index, uint16_t scan) {
  if (touched_[index] == stripe_stamp_) return;
  touched_[index] = stripe_stamp_;
  judged_[index] = scan;
  const int before = grid_.cells()[index];
  Change(index, std::min<int>((before == kUnobserved ? 0 : before) + steps_.hit, steps_.highest));
}

inline void MapUpdate::ApplyPass(int64_t index, uint16_t scan) {
  if (touched_[index] == stripe_stamp_) return;
  touched_[index] = stripe_stamp_;
  const int16_t before = grid_.cells()[index];
  if (before == steps_.lowest) return;
  if (IsOccupied(before)) {
    if (judged_[index] == scan) return;
    judged_[index] = scan;
  }
  Change(index, std::max<int>((before == kUnobserved ? 0 : before) - steps_.miss, steps_.lowest));
}

inline void MapUpdate::Change(int64_t index, int log_odds) {
  int16_t& cell = grid_.cells()[index];
  if (cell == log_odds) return;
  cell = static_cast<int16_t>(log_odds);
  changes_.Mark(index);
}

}  // namespace nbs
