#pragma once

#include <optional>

#include "common/config/run_config.h"
#include "common/kinematics/arm_body.h"
#include "services/planner/motion_planning/clearance.h"

namespace nbs {

/// What an arm touches. Itself, table and floor go before occupied, occupied before unknown: the first never changes.
enum class ArmTouch : uint8_t { kFree = 0, kUnknown = 1, kOccupied = 2, kSelf = 3 };

/// Collision of an arm and the sensor on its flange with the voxel space, the table, the floor and itself.
///
/// Every part but the base keeps the margin to the floor, which lies at the height of the base frame's origin; the base
/// stands on it. The sensor stays above the plane of the table also beside it: from below nothing can be seen. Parts of
/// the arm keep 5 mm from each other.
class ArmCollision {
 public:
  /// @pre The run has an arm, and `model` is its model.
  ArmCollision(const RunConfig& config, const ArmModel& model);

  const ArmModel& model() const { return model_; }
  const ArmBody& body() const { return body_; }
  const Pose& X_WB() const { return X_WB_; }
  double margin_m() const { return margin_m_; }

  /// What the arm comes nearer to than its margins. Exact where the clearance is: capsules and boxes of the arm against
  /// the cells of the map.
  ArmTouch FindTouch(const Clearance& clearance, const Joints& q) const;

  /// True if the arm touches something worse than `worst`. Looks no further than it must.
  bool Touches(const Clearance& clearance, const Joints& q, ArmTouch worst) const;

  /// True if the arm touches nothing.
  ///
  /// @param squeeze_m  Taken off the margin to the surroundings: for an arm that stands nearer than it should.
  bool IsFree(const Clearance& clearance, const Joints& q, double squeeze_m = 0.0) const;

  /// What the sensor by itself touches, wherever the arm is: not worse than FindTouch for any joint values that put the
  /// flange there.
  ArmTouch FindSensorTouch(const Clearance& clearance, const Pose& X_WF) const;

  /// True if the map alone comes nearer to the arm than `margin_m`.
  bool TouchesMap(const Clearance& clearance, Obstacles obstacles, const Joints& q, double margin_m) const;

  /// How much must be taken off the margin for the arm to be free, metres, to 1 mm above; 0 if it is free. nullopt if
  /// it touches even without any margin.
  std::optional<double> FindSqueeze(const Clearance& clearance, const Joints& q) const;

  /// True if the arm is free all along the straight line in joint space from one to the other.
  ///
  /// Conservative advancement (as swept_check.h): from a free state no part reaches anything before it has moved as far
  /// as its distance. The shortest step moves no point by more than kArmSweepTolerance, so between two states found
  /// free every part keeps its margin less half of that.
  ///
  /// @param squeeze_m  As in IsFree.
  bool IsFreeMotion(const Clearance& clearance, const Joints& q_from, const Joints& q_to, double squeeze_m = 0.0) const;

 private:
  Pose CalcPartPose(size_t part, const LinkPoses& X_BL) const {
    return X_WB_ * X_BL[static_cast<size_t>(body_.parts()[part].link)];
  }
  bool is_sensor(size_t part) const { return part > static_cast<size_t>(model_.n()); }
  double CalcFixedDistance(size_t part, const Eigen::Vector3d& p_W) const;
  double CalcPartSlack(const Clearance& clearance, size_t part, const Pose& X_WL, double enough_m) const;
  bool TouchesFixed(size_t part, const Pose& X_WL, double margin_m) const;
  bool TouchesFixed(size_t part, const Capsule& capsule_W) const;
  bool TouchesFixed(size_t part, const Block& block_W, double margin_m) const;
  bool TouchesMap(const Clearance& clearance, Obstacles obstacles, size_t part, const Pose& X_WL,
                  double margin_m) const;
  bool TouchesMap(const Clearance& clearance, Obstacles obstacles, const LinkPoses& X_BL, double margin_m) const;
  bool TouchesItself(const LinkPoses& X_BL, double margin_m) const;
  double CalcFreeStep(const Clearance& clearance, const Joints& q, const Joints& way, double left,
                      double squeeze_m) const;

  ArmModel model_;
  ArmBody body_;
  Pose X_WB_;
  double margin_m_;
  /// A block that reaches far down.
  struct Table {
    double top_z_m = 0.0;
    Eigen::Vector2d at_W = Eigen::Vector2d::Zero();
    Eigen::Vector3d half = Eigen::Vector3d::Zero();

    Eigen::Vector3d middle_W() const { return {at_W.x(), at_W.y(), top_z_m - half.z()}; }
  };
  std::optional<Table> table_;
};

/// Metres.
inline constexpr double kArmSweepTolerance = 0.005;
/// Between parts of the arm, metres; its bodies are expected to stand off its links by more than half a step.
inline constexpr double kSelfMargin = 0.0;

}  // namespace nbs
