#include "sim/oracle/partners.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace nbs {
namespace {

using Cell = std::array<int, 3>;
using Cells = std::map<Cell, std::vector<uint32_t>>;

Cell FindCell(const Eigen::Vector3d& p_W, double edge_m) {
  return {static_cast<int>(std::floor(p_W.x() / edge_m)), static_cast<int>(std::floor(p_W.y() / edge_m)),
          static_cast<int>(std::floor(p_W.z() / edge_m))};
}

void AppendCell(const Cells& cells, const Cell& cell, std::vector<uint32_t>& numbers) {
  const auto found = cells.find(cell);
  if (found != cells.end()) numbers.insert(numbers.end(), found->second.begin(), found->second.end());
}

}  // namespace

Partners::Partners(std::span<const SurfaceSample> samples, double max_distance_m, double max_angle_rad)
    : first_(samples.size() + 1, 0) {
  if (!(max_distance_m >= 0.0) || !std::isfinite(max_distance_m)) {
    throw std::invalid_argument("Partners: a distance of " + std::to_string(max_distance_m) + " m");
  }
  if (max_distance_m == 0.0) return;
  const double min_cosine = std::cos(max_angle_rad);
  Cells cells;
  for (size_t i = 0; i < samples.size(); ++i) {
    cells[FindCell(samples[i].p_W, max_distance_m)].push_back(static_cast<uint32_t>(i));
  }
  std::vector<uint32_t> near;
  for (size_t i = 0; i < samples.size(); ++i) {
    const SurfaceSample& sample = samples[i];
    const Cell cell = FindCell(sample.p_W, max_distance_m);
    near.clear();
    for (int k = 0; k < 27; ++k) {
      AppendCell(cells, {cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1}, near);
    }
    std::sort(near.begin(), near.end());
    for (uint32_t j : near) {
      if (j == i || (samples[j].p_W - sample.p_W).norm() > max_distance_m) continue;
      if (samples[j].normal_W.dot(sample.normal_W) >= min_cosine) numbers_.push_back(j);
    }
    first_[i + 1] = numbers_.size();
  }
}

}  // namespace nbs
