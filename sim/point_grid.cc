#include "sim/point_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {

PointGrid::PointGrid(double edge_m) : edge_m_(edge_m) {
  if (!(edge_m > 0.0) || !std::isfinite(edge_m)) {
    throw std::invalid_argument("PointGrid: an edge of " + std::to_string(edge_m) + " m");
  }
}

void PointGrid::Insert(const Eigen::Vector3d& p_W, uint32_t number) { cells_[FindCell(p_W)].push_back({p_W, number}); }

std::vector<uint32_t> PointGrid::FindNear(const Eigen::Vector3d& p_W) const {
  const Cell middle = FindCell(p_W);
  std::vector<uint32_t> numbers;
  for (int k = 0; k < 27; ++k) {
    const auto cell = cells_.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
    if (cell == cells_.end()) continue;
    for (const Point& point : cell->second) {
      if ((point.p_W - p_W).norm() <= edge_m_) numbers.push_back(point.number);
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

PointGrid::Cell PointGrid::FindCell(const Eigen::Vector3d& p_W) const {
  const auto along = [&](int axis) { return static_cast<int>(std::floor(p_W[axis] / edge_m_)); };
  return {along(0), along(1), along(2)};
}

}  // namespace nbs
