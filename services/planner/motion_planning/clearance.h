#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "common/kinematics/arm_model.h"
#include "common/mapping/distance_field.h"

namespace nbs {

/// How far a point is from what a body must not touch.
///
/// Both distances are in metres, 0 inside, and lower bounds: the true distance is never smaller. They may be truncated
/// above. The second counts unknown space as solid too, so it is never larger than the first.
class Clearance {
 public:
  virtual ~Clearance() = default;
  /// To the nearest occupied cell.
  virtual double CalcObstacleDistance(const Eigen::Vector3d& p_W) const = 0;
  /// To the nearest cell that is occupied or unknown.
  virtual double CalcUnknownDistance(const Eigen::Vector3d& p_W) const = 0;

  double CalcDistance(Obstacles obstacles, const Eigen::Vector3d& p_W) const {
    return obstacles == Obstacles::kOccupied ? CalcObstacleDistance(p_W) : CalcUnknownDistance(p_W);
  }

  /// True if an obstacle lies nearer to the capsule's line than its radius. Here by the distances of points of the
  /// line, 0.1 mm too near at most; exact where a class knows better.
  virtual bool IsTouched(Obstacles obstacles, const Capsule& capsule_W) const;

  /// True if an obstacle lies nearer than `margin_m` to the block, of which X_LC is X_WC. Here of the capsules that
  /// cover it; exact where a class knows better.
  virtual bool IsTouched(Obstacles obstacles, const Block& block_W, double margin_m) const;
};

/// No collision test at all, as in methods that do without.
class NothingSolid final : public Clearance {
 public:
  static constexpr double kFar_m = 10.0;
  double CalcObstacleDistance(const Eigen::Vector3d& /*p_W*/) const override { return kFar_m; }
  double CalcUnknownDistance(const Eigen::Vector3d& /*p_W*/) const override { return kFar_m; }
};

/// Another clearance with unknown space taken as free. Keeps a reference to it.
class ObstaclesOnly final : public Clearance {
 public:
  explicit ObstaclesOnly(const Clearance& inner) : inner_(inner) {}
  double CalcObstacleDistance(const Eigen::Vector3d& p_W) const override { return inner_.CalcObstacleDistance(p_W); }
  double CalcUnknownDistance(const Eigen::Vector3d& p_W) const override { return inner_.CalcObstacleDistance(p_W); }

 private:
  const Clearance& inner_;
};

/// Another clearance over a table: everything below the height `table_z_m` (metres in W) is occupied. Keeps a reference
/// to the other.
class AboveTable final : public Clearance {
 public:
  AboveTable(const Clearance& inner, double table_z_m) : inner_(inner), table_z_m_(table_z_m) {}
  double CalcObstacleDistance(const Eigen::Vector3d& p_W) const override {
    return std::min(inner_.CalcObstacleDistance(p_W), CalcTableDistance(p_W));
  }
  double CalcUnknownDistance(const Eigen::Vector3d& p_W) const override {
    return std::min(inner_.CalcUnknownDistance(p_W), CalcTableDistance(p_W));
  }

 private:
  double CalcTableDistance(const Eigen::Vector3d& p_W) const { return std::max(0.0, p_W.z() - table_z_m_); }

  const Clearance& inner_;
  double table_z_m_;
};

}  // namespace nbs
