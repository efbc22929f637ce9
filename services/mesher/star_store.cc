#include "services/mesher/star_store.h"

#include <algorithm>

namespace nbs {

const uint32_t* StarStore::Neighbours(const Header& header) const {
  switch (header.kind) {
    case 0:
      return small_[header.index].data();
    case 1:
      return medium_[header.index].data();
    case 2:
      return large_[header.index].data();
    default:
      return largest_[header.index].data();
  }
}

uint32_t StarStore::TakeBlock(uint8_t kind) {
  if (!free_[kind].empty()) {
    const uint32_t index = free_[kind].back();
    free_[kind].pop_back();
    return index;
  }
  const auto append = [](auto& blocks) {
    blocks.Append();
    return static_cast<uint32_t>(blocks.size() - 1);
  };
  switch (kind) {
    case 0:
      return append(small_);
    case 1:
      return append(medium_);
    case 2:
      return append(large_);
    default:
      return append(largest_);
  }
}

void StarStore::Set(uint32_t id, const LocalStar& star) {
  headers_.GrowTo(id + size_t{1});
  Header& header = headers_[id];
  uint8_t kind = 0;
  while (kCapacities[kind] < star.degree) ++kind;
  if (header.index == kNone || kind != header.kind) {
    if (header.index != kNone) free_[header.kind].push_back(header.index);
    header.kind = kind;
    header.index = TakeBlock(kind);
  }
  header.degree = star.degree;
  header.closed = star.closed;
  std::copy_n(star.neighbours.begin(), star.degree, Neighbours(header));
}

LocalStar StarStore::Get(uint32_t id) const {
  LocalStar star;
  if (id >= headers_.size() || headers_[id].index == kNone) return star;
  const Header& header = headers_[id];
  star.degree = header.degree;
  star.closed = header.closed;
  std::copy_n(Neighbours(header), header.degree, star.neighbours.begin());
  return star;
}

uint32_t StarStore::FindNext(uint32_t id, uint32_t neighbour) const {
  if (id >= headers_.size() || headers_[id].index == kNone) return LocalStar::kNone;
  const Header& header = headers_[id];
  const uint32_t* begin = Neighbours(header);
  const uint32_t* end = begin + header.degree;
  const uint32_t* at = std::find(begin, end, neighbour);
  if (at == end) return LocalStar::kNone;
  if (at + 1 != end) return at[1];
  return header.closed ? *begin : LocalStar::kNone;
}

}  // namespace nbs
