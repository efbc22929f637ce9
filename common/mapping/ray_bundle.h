#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/mapping/voxel_delta.h"

namespace nbs {

/// Instruction sets that rays are walked with. The result is the same with each.
enum class LaneSet : uint8_t {
  kSse42 = 0,   ///< 4 rays side by side; every machine that the project runs on.
  kAvx2 = 1,    ///< 8.
  kAvx512 = 2,  ///< 16; AVX-512 F, BW, DQ and VL.
};
inline constexpr std::array<LaneSet, 3> kLaneSets = {LaneSet::kSse42, LaneSet::kAvx2, LaneSet::kAvx512};

/// "sse4.2", "avx2", "avx512".
std::string_view ToString(LaneSet lanes);

/// Whether this processor has it.
bool IsSupported(LaneSet lanes);

/// The widest that this processor has.
LaneSet FindWidestLanes();

/// Where the rays of a bundle end.
enum class LastCell : uint8_t {
  kIncluded,  ///< In the cell of B.
  kLeftOut,   ///< In the cell before that of B; where B lies outside of the box, in the last cell of the box.
};

/// Rays from one point, walked side by side: cell by cell the same as those of MakeRayWalk and WalkRay (ray_walk.h).
///
/// Neighbouring rays pass through much the same cells; give them in order (the beams of a stripe).
class RayBundle {
 public:
  /// A cell whose value ends a ray, for Sum.
  static constexpr uint16_t kWall = 0xffff;
  /// A cell in which a ray ends and gains 1, for Sum.
  static constexpr uint16_t kGoal = 0xfffe;

  explicit RayBundle(const GridShape& shape, LaneSet lanes = FindWidestLanes());

  /// Forgets the rays and takes those from A to each B. Ends that are not finite or more than 1e9 cells away give a ray
  /// without cells.
  ///
  /// @param p_WA  Metres in W.
  /// @param ends_W  B of each ray, metres in W.
  void Set(const Eigen::Vector3d& p_WA, const std::vector<Eigen::Vector3d>& ends_W, LastCell last_cell);

  /// The cells that the rays pass through, each at least once. Most cells that several neighbours share come only once:
  /// two rays through the same cells of one octant reach each cell at the same step, where they are compared.
  ///
  /// @returns Cells in the bundle's own memory, which the caller may change; valid until the next call.
  std::span<uint32_t> ListCells();

  /// Sum over the rays of the values of the cells up to the first that is kWall or kGoal; kWall adds nothing, kGoal 1.
  ///
  /// @param values  By cell index; one entry behind the last cell is read but does not count.
  int64_t Sum(const uint16_t* values) const;

  /// Rays side by side, as arrays of equal length, padded with rays of no cells to whole groups of the widest lanes.
  struct Rays {
    std::vector<int32_t> index;  ///< First cell.
    std::vector<int32_t> steps;  ///< Steps to the last cell; -1: none at all.
    std::vector<int32_t> phase;  ///< Steps from a plane that is common to all rays of an octant to the first cell.
    std::array<std::vector<int32_t>, 3> t_max;  ///< As in RayWalk, less 2^31 (which keeps the order).
    std::array<std::vector<int32_t>, 3> t_delta;
    std::array<std::vector<int32_t>, 3> stride;

    void Resize(size_t count);
  };
  const Rays& rays() const { return rays_; }

 private:
  GridShape shape_;
  LaneSet lanes_;
  Rays rays_;
  std::vector<uint32_t> cells_;
};

}  // namespace nbs
