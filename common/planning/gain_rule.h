#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace nbs {

/// By what candidates are rated.
enum class GainRule : uint8_t {
  kSum = 0,           ///< "sum": the entropy of every cell along the beams (eq. 2 of the paper).
  kNearSurface = 1,   ///< "near_surface": of cells near the surface known so far: where it must go on.
  kMean = 2,          ///< "mean": eq. 2 per beam; a longer path does not win by its length.
  kPerSecond = 3,     ///< "per_second": eq. 2 per second of motion and scan.
  kUnknownCount = 4,  ///< "unknown_count": ln 2 for every beam that meets an unknown cell before an occupied one; the
                      ///< beam ends there (Wong, Dumont & Abidi, "Next best view system in a 3-D object modeling
                      ///< task", IEEE CIRA 1999).
  kSurface = 5,  ///< "surface": ln 2 for every voxel-sized piece of predicted, unseen surface that the path sees, each
                 ///< once (services/planner/surface_prediction).
};
inline constexpr int kGainRules = 6;

std::string_view ToString(GainRule rule);

/// The rule of a name as ToString gives it; none if no rule is called so.
std::optional<GainRule> FindGainRule(std::string_view name);

/// All names, in the order of the rules.
std::span<const std::string_view> GainRuleNames();

/// What a scan path costs.
struct PathCost {
  int64_t beams = 1;     ///< InformationGain::CountBeams, >= 1.
  double seconds = 1.0;  ///< Of the motion to the path and of the scan, > 0.
};

/// The figure by which candidates are ordered, the higher the better: the gain in nats (kSum, kNearSurface,
/// kUnknownCount, kSurface), nats per beam (kMean) or nats per second (kPerSecond).
///
/// @param gain_nat  Gain of the whole path.
/// @throws std::invalid_argument if the rule divides by a cost that is not positive.
double CalcScore(GainRule rule, double gain_nat, const PathCost& cost);

}  // namespace nbs
