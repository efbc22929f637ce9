#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace nbs {

/// Ascending, each once.
inline void SortUnique(std::vector<uint32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace nbs
