#pragma once

#include <span>
#include <string_view>

#include "common/planning/gain_rule.h"

namespace nbs {

/// Where a method's scan paths come from.
enum class CandidateSearch : uint8_t {
  kBoundary,         ///< Boundaries of the mesh (section III-A).
  kBoundaryAndHole,  ///< Boundaries, later its holes (section III-B).
  kSphere,           ///< Viewpoints on a sphere around the object (Wong, Dumont & Abidi, IEEE CIRA 1999).
};

/// When a method considers its work done; a run ends as well at its limit on scans, or when nothing is left to scan.
enum class EndRule : uint8_t {
  kCompleteness,    ///< The mesh completeness is as wanted (section III-F).
  kNothingLeft,     ///< With its last candidate.
  kUnknownSettled,  ///< The count of unknown voxels hardly changes any more.
};

/// A planner as section IV-B compares them: a named combination of candidate search, selection and end.
struct Method {
  std::string_view name;
  CandidateSearch search = CandidateSearch::kBoundaryAndHole;
  bool by_gain = true;  ///< Highest gain first; false: in the order of class and position of the boundaries.
  GainRule gain = GainRule::kSurface;  ///< Unless the run asks for another one; without meaning if not by_gain.
  EndRule end = EndRule::kCompleteness;
  bool collision_test = true;
};

/// All names: BH/IG, B/IG, B, S/IG, S.
std::span<const std::string_view> MethodNames();

/// The method of a name.
///
/// @throws std::invalid_argument if none is called so.
const Method& FindMethod(std::string_view name);

}  // namespace nbs
