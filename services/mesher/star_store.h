#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/mesher/local_star.h"
#include "services/mesher/paged_vector.h"

namespace nbs {

/// The star of each vertex, by its number, in as little memory as most stars need: six neighbours on average, twenty at
/// most.
class StarStore {
 public:
  void Set(uint32_t id, const LocalStar& star);
  /// An empty star if none was set.
  LocalStar Get(uint32_t id) const;
  /// LocalStar::FindNext of the star of `id`.
  uint32_t FindNext(uint32_t id, uint32_t neighbour) const;
  bool IsClosed(uint32_t id) const { return id < headers_.size() && headers_[id].closed; }

 private:
  static constexpr std::array<uint8_t, 4> kCapacities{6, 8, 12, LocalStar::kMaxDegree};
  static constexpr uint32_t kNone = 0xffffffffu;

  /// Where a star lies: `index` among the blocks of its capacity.
  struct Header {
    uint32_t index = kNone;
    uint8_t degree = 0;
    uint8_t kind = 0;  ///< Of its capacity.
    bool closed = false;
  };
  template <size_t kCapacity>
  using Block = std::array<uint32_t, kCapacity>;

  const uint32_t* Neighbours(const Header& header) const;
  uint32_t* Neighbours(const Header& header) {
    return const_cast<uint32_t*>(static_cast<const StarStore*>(this)->Neighbours(header));
  }
  uint32_t TakeBlock(uint8_t kind);

  PagedVector<Header> headers_;
  PagedVector<Block<kCapacities[0]>> small_;
  PagedVector<Block<kCapacities[1]>> medium_;
  PagedVector<Block<kCapacities[2]>> large_;
  PagedVector<Block<kCapacities[3]>> largest_;
  std::array<std::vector<uint32_t>, 4> free_;  // Blocks, by kind.
};

}  // namespace nbs
