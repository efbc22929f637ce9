#include "common/mapping/ray_bundle.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "common/mapping/ray_lanes.h"

namespace nbs {
namespace {

constexpr double kMaxCells = 1e9;

const lanes::Kernels& KernelsOf(LaneSet set) {
  switch (set) {
    case LaneSet::kAvx512:
      return lanes::kAvx512Kernels;
    case LaneSet::kAvx2:
      return lanes::kAvx2Kernels;
    default:
      return lanes::kSse42Kernels;
  }
}

/// The kernels read rays and write only in set_up, for which there is the other function.
lanes::RayArrays ToArrays(RayBundle::Rays& rays) {
  lanes::RayArrays arrays{rays.index.data(), rays.steps.data(), rays.phase.data(), {}, {}, {}};
  for (int axis = 0; axis < 3; ++axis) {
    arrays.t_max[axis] = rays.t_max[axis].data();
    arrays.t_delta[axis] = rays.t_delta[axis].data();
    arrays.stride[axis] = rays.stride[axis].data();
  }
  return arrays;
}

lanes::RayArrays ToArrays(const RayBundle::Rays& rays) { return ToArrays(const_cast<RayBundle::Rays&>(rays)); }

}  // namespace

std::string_view ToString(LaneSet lanes) {
  constexpr std::array<std::string_view, kLaneSets.size()> kNames = {"sse4.2", "avx2", "avx512"};
  return kNames.at(static_cast<size_t>(lanes));
}

bool IsSupported(LaneSet lanes) {
  __builtin_cpu_init();
  switch (lanes) {
    case LaneSet::kAvx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
    case LaneSet::kAvx2:
      return __builtin_cpu_supports("avx2") != 0;
    default:
      return true;
  }
}

LaneSet FindWidestLanes() {
  static const LaneSet widest = IsSupported(LaneSet::kAvx512) ? LaneSet::kAvx512
                                : IsSupported(LaneSet::kAvx2) ? LaneSet::kAvx2
                                                              : LaneSet::kSse42;
  return widest;
}

void RayBundle::Rays::Resize(size_t count) {
  const size_t padded = (count + lanes::kWidest - 1) / lanes::kWidest * lanes::kWidest;
  for (std::vector<int32_t>* array : {&index, &steps, &phase}) array->resize(padded);
  for (int axis = 0; axis < 3; ++axis) {
    for (std::vector<int32_t>* array : {&t_max[axis], &t_delta[axis], &stride[axis]}) array->resize(padded);
  }
  for (size_t i = count; i < padded; ++i) {
    steps[i] = -1;
    index[i] = 0;
  }
}

RayBundle::RayBundle(const GridShape& shape, LaneSet lanes) : shape_(shape), lanes_(lanes) {
  if (!IsSupported(lanes))
    throw std::invalid_argument("RayBundle: this processor has no " + std::string(ToString(lanes)));
}

void RayBundle::Set(const Eigen::Vector3d& p_WA, const std::vector<Eigen::Vector3d>& ends_W, LastCell last_cell) {
  lanes::Box box{};
  box.cells_per_m = 1.0 / shape_.resolution_m;
  bool good = true;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::round(shape_.origin_W[axis] * box.cells_per_m);
    box.size[axis] = shape_.size[axis];
    box.p_WA[axis] = p_WA[axis] * box.cells_per_m;
    good = good && std::abs(box.p_WA[axis]) < kMaxCells;
  }
  const size_t count = good ? ends_W.size() : 0;
  rays_.Resize(count);
  if (count == 0) return;
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  KernelsOf(lanes_).set_up(box, ends_W.front().data(), count, last_cell == LastCell::kLeftOut, ToArrays(rays_));
}

std::span<uint32_t> RayBundle::ListCells() {
  size_t room = lanes::kWidest;
  for (const int32_t steps : rays_.steps) room += static_cast<size_t>(steps + 1);
  if (cells_.size() < room) cells_.resize(room);
  return {cells_.data(), KernelsOf(lanes_).list(ToArrays(rays_), rays_.steps.size(), cells_.data())};
}

int64_t RayBundle::Sum(const uint16_t* values) const {
  return static_cast<int64_t>(KernelsOf(lanes_).sum(ToArrays(rays_), rays_.steps.size(), values));
}

}  // namespace nbs
