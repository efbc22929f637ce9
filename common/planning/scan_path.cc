#include "common/planning/scan_path.h"

#include <array>

namespace nbs {

std::string_view ToString(CandidateSource source) {
  constexpr std::array<std::string_view, 4> kNames = {"first", "boundary", "hole", "sphere"};
  return kNames.at(static_cast<size_t>(source));
}

std::string_view ToString(Verdict verdict) {
  constexpr std::array<std::string_view, kVerdicts> kNames = {
      "chosen",    "reachable",        "partly",  "blocked_by_obstacle", "blocked_by_unknown",
      "no_motion", "out_of_workspace", "no_gain", "not_tried",           "dropped"};
  return kNames.at(static_cast<size_t>(verdict));
}

}  // namespace nbs
