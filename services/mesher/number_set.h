#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace nbs {

/// Numbers, at a bit each, that is emptied in the time that filling it took.
class NumberSet {
 public:
  void Insert(std::span<const uint32_t> ids) {
    for (uint32_t id : ids) {
      if (id >= holds_.size()) holds_.resize(id + size_t{1}, false);
      if (holds_[id]) continue;
      holds_[id] = true;
      list_.push_back(id);
    }
  }
  bool Contains(uint32_t id) const { return id < holds_.size() && holds_[id]; }
  void Clear() {
    for (uint32_t id : list_) holds_[id] = false;
    list_.clear();
  }

 private:
  std::vector<bool> holds_;
  std::vector<uint32_t> list_;
};

}  // namespace nbs
