#include "services/mesher/lag_queue.h"

#include <algorithm>

namespace nbs {

void LagQueue::TakeDue(const Moment& now, double lag_m, int64_t lag_stripes, std::vector<uint32_t>& ids) {
  ids.clear();
  while (!entries_.empty()) {
    const Entry& oldest = entries_.front();
    if (now.path_m - oldest.moment.path_m < lag_m && now.stripes - oldest.moment.stripes < lag_stripes) break;
    ids.push_back(oldest.id);
    entries_.pop_front();
  }
  std::sort(ids.begin(), ids.end());
}

void LagQueue::TakeAll(std::vector<uint32_t>& ids) {
  ids.clear();
  for (const Entry& entry : entries_) ids.push_back(entry.id);
  entries_.clear();
  std::sort(ids.begin(), ids.end());
}

}  // namespace nbs
