#include "services/planner/motion_planning/escape.h"

#include <algorithm>

namespace nbs {
namespace {

/// Backwards first, forwards last; unit vectors.
std::vector<Eigen::Vector3d> MakeDirections(const Eigen::Matrix3d& R_WS) {
  const Eigen::Vector3d x = R_WS.col(0);
  const Eigen::Vector3d y = R_WS.col(1);
  const Eigen::Vector3d z = R_WS.col(2);
  std::vector<Eigen::Vector3d> directions = {-z};
  for (const Eigen::Vector3d& side : {x, Eigen::Vector3d(-x), y, Eigen::Vector3d(-y)})
    directions.push_back((side - z).normalized());
  directions.insert(directions.end(), {x, -x, y, -y, z});
  return directions;
}

}  // namespace

std::optional<Pose> FindEscape(const CollisionBody& body_F, const Clearance& clearance, const Pose& X_WF_now,
                               const Eigen::Matrix3d& R_WS) {
  const double slack = body_F.CalcSlack(clearance, X_WF_now);
  if (slack >= 0.0) return X_WF_now;
  const double left_m = body_F.margin_m() + slack;
  if (left_m < 0.0) return std::nullopt;
  const CollisionBody squeezed_F = body_F.WithMargin(left_m);
  const std::vector<Eigen::Vector3d> directions = MakeDirections(R_WS);
  for (const double distance_m : {0.02, 0.05, 0.1, 0.2}) {
    for (const Eigen::Vector3d& direction_W : directions) {
      Pose X_WF = X_WF_now;
      X_WF.translation() += distance_m * direction_W;
      if (body_F.FindTouch(clearance, X_WF) == Touch::kFree && IsFreeMotion(squeezed_F, clearance, X_WF_now, X_WF))
        return X_WF;
    }
  }
  return std::nullopt;
}

}  // namespace nbs
