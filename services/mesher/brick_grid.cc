#include "services/mesher/brick_grid.h"

#include <stdexcept>
#include <string>

namespace nbs {

BrickGrid::BrickGrid(float cell_m) : inverse_cell_(1.0f / cell_m), keys_(1024, 0), values_(1024, kNone) {
  if (!(cell_m >= 1e-4f)) throw std::invalid_argument("BrickGrid: cell of " + std::to_string(cell_m) + " m");
}

size_t BrickGrid::SlotOf(uint64_t key) const {
  const size_t mask = keys_.size() - 1;
  size_t slot = (key * 0x9e3779b97f4a7c15ull >> 20) & mask;
  while (keys_[slot] != 0 && keys_[slot] != key + 1) slot = (slot + 1) & mask;
  return slot;
}

int32_t BrickGrid::FindBrick(uint64_t key) const {
  const size_t slot = SlotOf(key);
  return keys_[slot] == 0 ? kNone : values_[slot];
}

int32_t BrickGrid::InsertBrick(uint64_t key) {
  size_t slot = SlotOf(key);
  if (keys_[slot] != 0 && values_[slot] != kNone) return values_[slot];
  if (keys_[slot] == 0) {
    if (2 * ++key_count_ > keys_.size()) {
      Grow();
      slot = SlotOf(key);
    }
    keys_[slot] = key + 1;
  }
  if (free_.empty()) {
    values_[slot] = static_cast<int32_t>(bricks_.size());
    bricks_.push_back(std::make_unique<Brick>());
  } else {
    values_[slot] = free_.back();
    free_.pop_back();
  }
  Brick& brick = *bricks_[values_[slot]];
  brick.heads.fill(kNone);
  brick.rows.fill(0);
  brick.filled = 0;
  return values_[slot];
}

void BrickGrid::Grow() {
  std::vector<uint64_t> keys(2 * keys_.size(), 0);
  std::vector<int32_t> values(keys.size(), kNone);
  keys.swap(keys_);
  values.swap(values_);
  for (size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == 0) continue;
    const size_t slot = SlotOf(keys[i] - 1);
    keys_[slot] = keys[i];
    values_[slot] = values[i];
  }
}

int32_t& BrickGrid::Touch(const Eigen::Vector3f& p_W) {
  const Cell cell = CellOf(p_W);
  Brick& brick = *bricks_[InsertBrick(KeyOf(cell.x() >> kShift, cell.y() >> kShift, cell.z() >> kShift))];
  const int x = cell.x() & kMask, y = cell.y() & kMask, z = cell.z() & kMask;
  uint8_t& row = brick.rows[kEdge * x + y];
  brick.filled += (row >> z & 1) == 0;
  row |= static_cast<uint8_t>(1u << z);
  return brick.heads[kEdge * (kEdge * x + y) + z];
}

int32_t BrickGrid::Find(const Eigen::Vector3f& p_W) const {
  const Cell cell = CellOf(p_W);
  const int32_t brick = FindBrick(KeyOf(cell.x() >> kShift, cell.y() >> kShift, cell.z() >> kShift));
  return brick == kNone
             ? kNone
             : bricks_[brick]->heads[kEdge * (kEdge * (cell.x() & kMask) + (cell.y() & kMask)) + (cell.z() & kMask)];
}

void BrickGrid::Clear(const Eigen::Vector3f& p_W) {
  const Cell cell = CellOf(p_W);
  const uint64_t key = KeyOf(cell.x() >> kShift, cell.y() >> kShift, cell.z() >> kShift);
  const int32_t number = FindBrick(key);
  if (number == kNone) return;
  Brick& brick = *bricks_[number];
  const int x = cell.x() & kMask, y = cell.y() & kMask, z = cell.z() & kMask;
  uint8_t& row = brick.rows[kEdge * x + y];
  if ((row >> z & 1) == 0) return;
  row &= static_cast<uint8_t>(~(1u << z));
  brick.heads[kEdge * (kEdge * x + y) + z] = kNone;
  if (--brick.filled > 0) return;
  values_[SlotOf(key)] = kNone;
  free_.push_back(number);
}

}  // namespace nbs
