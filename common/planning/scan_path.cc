#include "common/planning/scan_path.h"

#include <array>

namespace nbs {
namespace {

/// Half a turn about z, without rounding.
Pose Roll(const Pose& X_WS) {
  Pose X = X_WS;
  X.linear().col(0) = -X_WS.linear().col(0);
  X.linear().col(1) = -X_WS.linear().col(1);
  return X;
}

}  // namespace

ScanPath RollPath(const ScanPath& path) { return {Roll(path.X_WS_start), Roll(path.X_WS_end)}; }

std::string_view ToString(CandidateSource source) {
  constexpr std::array<std::string_view, 4> kNames = {"first", "boundary", "hole", "sphere"};
  return kNames.at(static_cast<size_t>(source));
}

std::string_view ToString(Verdict verdict) {
  constexpr std::array<std::string_view, kVerdicts> kNames = {"chosen",
                                                              "reachable",
                                                              "partly",
                                                              "blocked_by_obstacle",
                                                              "blocked_by_unknown",
                                                              "no_motion",
                                                              "no_inverse_kinematics",
                                                              "no_gain",
                                                              "not_tried",
                                                              "dropped",
                                                              "joint_limit",
                                                              "speed",
                                                              "self_collision"};
  return kNames.at(static_cast<size_t>(verdict));
}

}  // namespace nbs
