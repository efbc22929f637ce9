#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/kinematics/arm_model.h"
#include "common/kinematics/spherical_wrist_ik.h"

namespace nbs {

/// How joint values are found for a pose of the flange.
enum class IkMethod : uint8_t {
  kAnalytic = 0,  ///< SphericalWristIk: all solutions, exact.
  kNumeric = 1,   ///< Damped least squares from several starts: any chain, no promise to find every solution.
};

struct NumericIkSettings {
  int iterations = 60;
  double tolerance_m = 1e-10;  ///< Of the flange's origin; of its orientation the same number in radians.
  double largest_step_rad = 0.5;
};

/// Joint values near `q_start`, within the limits, that put the flange at X_BF, by damped least squares (Wampler, IEEE
/// Trans. SMC 16(1), 1986, DOI 10.1109/TSMC.1986.289285), the damping falling with the error. nullopt if it does not
/// get there.
std::optional<Joints> FindJointsNear(const ArmModel& model, const Pose& X_BF, const Joints& q_start,
                                     const NumericIkSettings& settings = {});

/// Inverse kinematics of one arm.
class InverseKinematics {
 public:
  /// @throws std::invalid_argument if the method is analytic and the arm is not of its kind.
  InverseKinematics(const ArmModel& model, IkMethod method);

  /// All joint values within the limits that put the flange at X_BF, those among them that differ by whole turns of a
  /// joint: exact and complete if analytic; if numeric what is found from the values in `near` and from 24 fixed starts
  /// (8 if `near` is not empty). In a fixed order; equal input gives equal output.
  ///
  /// @param near  Also the hint for joint 4 where the axes of joints 4 and 6 fall together.
  std::vector<Joints> FindAll(const Pose& X_BF, std::span<const Joints> near = {}) const;

  /// True if the pose could be reached by joints without limits. Numeric: always true.
  bool IsInReach(const Pose& X_BF) const;

  const ArmModel& model() const { return model_; }

 private:
  std::vector<Joints> FindNumeric(const Pose& X_BF, std::span<const Joints> near) const;

  ArmModel model_;
  std::optional<SphericalWristIk> analytic_;
};

}  // namespace nbs
