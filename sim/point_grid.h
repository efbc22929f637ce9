#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace nbs {

/// Points by the cubic cell that they lie in, to find those near a place.
class PointGrid {
 public:
  /// @param edge_m  Of a cell, and the farthest that FindNear reaches; > 0.
  /// @throws std::invalid_argument if the edge is not positive and finite.
  explicit PointGrid(double edge_m);

  /// Adds a point under a number of the caller's.
  void Insert(const Eigen::Vector3d& p_W, uint32_t number);

  /// Numbers of the points within edge_m of p_W (inclusive), rising.
  std::vector<uint32_t> FindNear(const Eigen::Vector3d& p_W) const;

 private:
  using Cell = std::array<int, 3>;
  struct Point {
    Eigen::Vector3d p_W;
    uint32_t number;
  };
  Cell FindCell(const Eigen::Vector3d& p_W) const;

  double edge_m_;
  std::map<Cell, std::vector<Point>> cells_;
};

}  // namespace nbs
