#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// Axis-aligned boxes with exact distances, truncated at 0.3 m like a distance field's.
class BoxWorld final : public Clearance {
 public:
  std::vector<Eigen::AlignedBox3d> occupied;
  std::vector<Eigen::AlignedBox3d> unknown;

  double CalcObstacleDistance(const Eigen::Vector3d& p_W) const override { return CalcDistance(occupied, p_W); }
  double CalcUnknownDistance(const Eigen::Vector3d& p_W) const override {
    return std::min(CalcDistance(occupied, p_W), CalcDistance(unknown, p_W));
  }

 private:
  static double CalcDistance(const std::vector<Eigen::AlignedBox3d>& boxes, const Eigen::Vector3d& p_W) {
    double distance = 0.3;
    for (const Eigen::AlignedBox3d& box : boxes) distance = std::min(distance, box.exteriorDistance(p_W));
    return distance;
  }
};

}  // namespace nbs
