#include "common/messages/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/kinematics/arm_model.h"

namespace nbs {
namespace {

constexpr float kFurthest_m = 1000.0f;  // No cell is larger, and scan paths are laid along all of a mesh.

bool IsCount(std::initializer_list<int64_t> values) {
  return std::all_of(values.begin(), values.end(), [](int64_t value) { return value >= 0; });
}

template <typename Range>
bool IsFinite(const Range& values) {
  return std::all_of(values.begin(), values.end(), [](auto value) { return std::isfinite(value); });
}

bool IsSound(const RatedCandidate& rated) {
  const Candidate& c = rated.candidate;
  return IsRigid(c.path.X_WS_start) && IsRigid(c.path.X_WS_end) && std::isfinite(rated.gain_nat);
}

bool AreJoints(const std::vector<double>& joints_rad) {
  return joints_rad.size() <= kMaxJoints && IsFinite(joints_rad);
}

bool IsSound(const TrajectoryPoint& point) {
  return point.time_us >= 0 && IsRigid(point.X_WF) && AreJoints(point.joints_rad);
}

bool IsSound(const MeshVertex& v) {
  return v.id < kMaxSlots && v.p_W.cwiseAbs().maxCoeff() <= kFurthest_m && v.p_W.allFinite() &&
         v.normal_W.allFinite() && std::isfinite(v.sigma_m) && v.sigma_m >= 0.0f && v.best_incidence_rad >= 0.0f &&
         v.best_incidence_rad <= std::numbers::pi_v<float>;
}

bool IsSound(const MeshTriangle& t) {
  return t.id < kMaxSlots &&
         std::all_of(t.vertices.begin(), t.vertices.end(), [](uint32_t v) { return v < kMaxSlots; });
}

template <typename T>
bool AreSound(const std::vector<T>& elements) {
  return std::all_of(elements.begin(), elements.end(), [](const T& element) { return IsSound(element); });
}

std::string Fault(const PlanRequest&) { return {}; }
std::string Fault(const RunState&) { return {}; }
std::string Fault(const Execution&) { return {}; }
std::string Fault(const Profile&) { return {}; }

std::string Fault(const Trajectory& trajectory) {
  return AreSound(trajectory.points) ? "" : "a point of the trajectory is unsound";
}

std::string Fault(const RobotState& state) {
  if (!IsRigid(state.X_WF)) return "X_WF is no rigid transform";
  return AreJoints(state.joints_rad) ? "" : "a joint is not finite, or there are too many of them";
}

std::string Fault(const Stripe& stripe) {
  if (stripe.index < 0) return "the index is negative";
  if (!IsRigid(stripe.X_WS)) return "X_WS is no rigid transform";
  const auto is_range = [](float range) { return std::isfinite(range) && range >= 0.0f; };
  return std::all_of(stripe.ranges_m.begin(), stripe.ranges_m.end(), is_range) ? ""
                                                                               : "a range is negative or not finite";
}

std::string Fault(const MeshDelta& delta) {
  if (!AreSound(delta.vertices)) return "a vertex is unsound";
  return AreSound(delta.triangles) ? "" : "a triangle is unsound";
}

std::string Fault(const MeshScan& s) {
  if (!IsCount({s.stripes, s.points, s.refused, s.vertices, s.triangles, s.edges, s.border_edges}))
    return "a count is negative";
  if (!std::isfinite(s.rim_length_m) || s.rim_length_m < 0.0) return "the rim's length is negative or not finite";
  return s.completeness >= 0.0 && s.completeness <= 1.0 ? "" : "the completeness is not between 0 and 1";
}

std::string Fault(const VoxelDelta& delta) {
  int64_t cells = 0;
  int64_t first_free = 0;
  for (size_t i = 0; i < delta.run_start.size(); ++i) {
    if (delta.run_length[i] == 0) return "a run of voxels is empty";
    if (delta.run_start[i] < first_free) return "runs of voxels overlap or are out of order";
    first_free = int64_t{delta.run_start[i]} + delta.run_length[i];
    cells += delta.run_length[i];
  }
  return cells == static_cast<int64_t>(delta.values.size()) ? "" : "runs and values of voxels do not add up";
}

std::string Fault(const Plan& plan) {
  if (plan.unknown_cells < 0) return "the count of unknown cells is negative";
  if (!IsSound(plan.chosen)) return "the chosen candidate is unsound";
  if (!IsCount({plan.trajectory.utime_us, plan.trajectory.scan})) return "the trajectory's time or scan is negative";
  return AreSound(plan.trajectory.points) ? "" : "a point of the trajectory is unsound";
}

std::string Fault(const CandidateSet& set) { return AreSound(set.candidates) ? "" : "a candidate is unsound"; }

std::string Fault(const PlanTiming& t) {
  const std::initializer_list<double> sums_s = {t.update_s, t.candidates_s, t.gain_s, t.motion_s, t.total_s};
  return IsFinite(sums_s) && IsFinite(t.plans_s) ? "" : "a duration is not finite";
}

template <typename T>
bool HasBadScan(const T& message) {
  if constexpr (requires { message.scan; }) {
    return message.scan < 0 || message.scan > kMaxScans;
  } else {
    return false;
  }
}

}  // namespace

std::string FindFault(const Message& message) {
  return std::visit(
      [](const auto& m) -> std::string {
        if (m.utime_us < 0) return "utime is negative";
        if (HasBadScan(m)) return "the scan's number is negative or too high";
        return Fault(m);
      },
      message);
}

}  // namespace nbs
