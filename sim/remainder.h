#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/config/run_config.h"
#include "sim/coverage.h"

namespace nbs {

/// Why a piece of the true surface is missing in a reconstruction; the first that applies.
enum class Missing : uint8_t {
  kOpen = 0,    ///< Nothing stands in the way: it could have been scanned.
  kNoRoom = 1,  ///< There is a line of sight, but wherever it can be measured from the sensor's body does not fit.
  kBase = 2,    ///< Only the table is in the way: the object stands on it, or close to it.
  kDepthOfField = 3,  ///< Lines of sight end before the nearest depth: a place too narrow for the profiler.
  kOccluded = 4,      ///< The object itself hides it.
};
inline constexpr int kMissingKinds = 5;

/// open, no_room, base, depth_of_field, occluded.
std::string_view ToString(Missing kind);

struct RemainderSettings {
  Profiler profiler;
  std::optional<double> table_z_m;  ///< Top of the table; none: the object may be looked at from anywhere.
  std::vector<Sphere> body_S;       ///< The sensor's body.
  double body_margin_m = 0.02;      ///< Kept between the body and the object, and the table.
  double narrow_m = 0.03;           ///< A free sight of this length makes a narrow place, a shorter one a hidden one.
  double rim_reach_m = 0.006;       ///< What is missing this near to a border edge is what lies beyond it.
  double standoff_step_m = 0.05;    ///< Between the stand-offs at which room for the body is looked for.
};

/// What a reconstruction lacks, and what lies beyond its borders.
struct Remainder {
  std::array<double, kMissingKinds> missing{};  ///< By kind: share of the true surface that is not covered.
  std::array<double, kMissingKinds> rim_m{};    ///< By kind: length of the borders beside such a surface, metres.
  double seam_m =
      0.0;  ///< Length of the borders beside which nothing is missing: cracks, and gaps of a few millimetres.
};

/// Explains what a reconstruction lacks, by looking at the true object from 256 directions, and the normal, at each
/// sample that is not covered: a bound from above on what could be measured, since neither the robot's reach nor the
/// camera's line of sight is looked at. An edge of the border belongs to the missing sample that is nearest to its
/// middle.
class RemainderExplainer {
 public:
  /// @param truth_W  The true object, triangles counter-clockwise seen from outside.
  /// @param oracle   Of the same object: its samples, and what covers them. Must outlive this.
  RemainderExplainer(const TriangleMesh& truth_W, const CoverageOracle& oracle, const RemainderSettings& settings);

  Remainder Explain(const TriangleMesh& mesh_W) const;

  /// Why this piece of surface would be missing.
  Missing Classify(const SurfaceSample& sample) const;

 private:
  bool IsFree(const SurfaceSample& sample, const Eigen::Vector3d& direction_W, double length_m) const;
  bool IsAboveTable(const Eigen::Vector3d& p_W) const;
  bool HasRoom(const SurfaceSample& sample, const Eigen::Vector3d& direction_W) const;
  bool BodyFits(const Eigen::Vector3d& p_WS, const Eigen::Vector3d& direction_W) const;

  RemainderSettings settings_;
  const CoverageOracle* oracle_;
  TriangleScene truth_W_;
  std::vector<Eigen::Vector3d> directions_W_;
};

}  // namespace nbs
