#pragma once

#include <cstddef>
#include <cstdint>

// Inner loops of RayBundle, once for each instruction set. No type of Eigen or the standard library passes through
// here: code for different instruction sets must not meet in a function that the linker takes for one and the same.

namespace nbs::lanes {

/// Most rays that any set walks at a time: arrays are padded to a multiple of it.
inline constexpr size_t kWidest = 16;

/// The box of a grid and the common start of the rays, in cells from W's origin.
struct Box {
  double low[3];
  int32_t size[3];
  double p_WA[3];
  double cells_per_m;
};

/// Arrays of RayBundle::Rays. A t_max holds the tick less 2^31, so that signed comparisons order it.
struct RayArrays {
  int32_t* index;
  int32_t* steps;
  int32_t* phase;
  int32_t* t_max[3];
  int32_t* t_delta[3];
  int32_t* stride[3];
};

/// The functions of one instruction set.
struct Kernels {
  /// Readies `count` rays to the ends b (x, y, z in turn, metres).
  void (*set_up)(const Box& box, const double* b, size_t count, bool leave_out_last, const RayArrays& rays);
  /// Writes the cells of all rays, those of equal neighbours once; returns how many. `cells` has room for every cell of
  /// every ray and kWidest more.
  size_t (*list)(const RayArrays& rays, size_t padded_count, uint32_t* cells);
  /// RayBundle::Sum.
  uint64_t (*sum)(const RayArrays& rays, size_t padded_count, const uint16_t* values);
};

extern const Kernels kSse42Kernels;
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;

}  // namespace nbs::lanes
