#include "services/voxelmap/map_update.h"

#include <algorithm>
#include <utility>

namespace nbs {

MapUpdate::MapUpdate(const GridShape& shape, const Profiler& profiler, const InverseSensorModelSettings& settings,
                     LaneSet lanes)
    : profiler_(profiler),
      settings_(settings),
      steps_(MakeLogOddsSteps(settings)),
      directions_S_(CalcBeamDirections_S(profiler)),
      grid_(shape),
      finder_(shape),
      rays_(shape, lanes),
      changes_(shape.cells()),
      touched_words_((shape.cells() + 63) / 64, 0),
      judged_(shape.cells(), 0) {}

void MapUpdate::Insert(const Stripe& stripe) {
  BeginStripe();
  evidence_ = CalcStripeEvidence(profiler_, directions_S_, settings_.free_margin_sigma, stripe, std::move(evidence_));
  const uint16_t scan = static_cast<uint16_t>(stripe.scan + 1);
  for (const Eigen::Vector3d& p_W : evidence_.hits_W) {
    const int64_t index = finder_.Find(p_W);
    if (index >= 0) ApplyHit(static_cast<uint32_t>(index), scan);
  }
  for (const FreeFan& fan : evidence_.fans) {
    rays_.Set(fan.p_WA, fan.ends_W, LastCell::kLeftOut);
    ApplyPasses(TakeFresh(rays_.ListCells()), scan);
  }
}

void MapUpdate::BeginStripe() {
  for (const uint32_t index : touched_) touched_words_[index >> 6] = 0;
  touched_.clear();
}

void MapUpdate::ApplyHit(uint32_t index, uint16_t scan) {
  uint64_t& word = touched_words_[index >> 6];
  const uint64_t bit = uint64_t{1} << (index & 63);
  if ((word & bit) != 0) return;
  word |= bit;
  touched_.push_back(index);
  judged_[index] = scan;
  int16_t& cell = grid_.cells()[index];
  const int after = std::min<int>((cell == kUnobserved ? 0 : cell) + steps_.hit, steps_.highest);
  if (cell == after) return;
  cell = static_cast<int16_t>(after);
  changes_.Mark(index);
}

std::span<uint32_t> MapUpdate::TakeFresh(std::span<uint32_t> cells) {
  size_t fresh = 0;
  for (const uint32_t index : cells) {
    uint64_t& word = touched_words_[index >> 6];
    const uint64_t touched = word, bit = uint64_t{1} << (index & 63);
    __builtin_prefetch(grid_.cells().data() + index, 1);
    // Without a branch: whether a cell was touched is a toss-up.
    cells[fresh] = index;
    fresh += (touched & bit) == 0 ? 1 : 0;
    word = touched | bit;
  }
  touched_.insert(touched_.end(), cells.begin(), cells.begin() + fresh);
  return cells.first(fresh);
}

void MapUpdate::ApplyPasses(std::span<uint32_t> fresh, uint16_t scan) {
  int16_t* log_odds = grid_.cells().data();
  const int miss = steps_.miss, lowest = steps_.lowest;
  size_t changed = 0;
  for (const uint32_t index : fresh) {
    const int16_t before = log_odds[index];
    if (IsOccupied(before)) [[unlikely]] {
      if (!TakesPass(index, scan)) continue;
    }
    const int after = std::max((before == kUnobserved ? 0 : before) - miss, lowest);
    log_odds[index] = static_cast<int16_t>(after);
    fresh[changed] = index;
    changed += after != before ? 1 : 0;
  }
  changes_.MarkAll(fresh.first(changed));
}

bool MapUpdate::TakesPass(uint32_t index, uint16_t scan) {
  if (!settings_.spare_occupied) return true;
  return std::exchange(judged_[index], scan) != scan;
}

}  // namespace nbs
