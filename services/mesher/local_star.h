#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace nbs {

/// A vertex that may join another's star.
struct StarCandidate {
  uint32_t id = 0;
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();  ///< Metres.
};

/// The Delaunay neighbours of one vertex in its own tangent plane, counter-clockwise seen from the normal's tip.
struct LocalStar {
  static constexpr int kMaxDegree = 20;
  std::array<uint32_t, kMaxDegree> neighbours{};
  uint8_t degree = 0;
  bool closed = false;  ///< True: the last neighbour and the first are a pair too; false: the star opens at least a
                        ///< straight angle between them.

  /// The neighbour that follows `id` counter-clockwise, or kNone if none does.
  uint32_t FindNext(uint32_t id) const;
  static constexpr uint32_t kNone = 0xffffffffu;

  bool operator==(const LocalStar& other) const;
};

/// Working space of CalcLocalStar, kept by the caller to spare allocations.
struct StarScratch {
  struct Point {
    double x = 0.0, y = 0.0;  // Inverted.
    double turn = 0.0;        // Stands for the angle.
    uint32_t id = 0;
  };
  std::vector<Point> points;
  std::vector<Point> hull;
};

/// Delaunay star of the vertex at p_W among the candidates, in the plane across its normal. A candidate is laid down at
/// its true distance, in the direction in which it is seen along the plane, so that a surface that bends away is
/// unrolled rather than squeezed.
///
/// The star of the origin is the convex hull of the inverted points q/|q|^2 (Brown, Inf. Proc. Letters 1979): sorted by
/// angle, then one Graham pass. Ties in angle go to the nearer candidate, then to the smaller id. If more than
/// kMaxDegree candidates are given only the nearest kMaxDegree count.
///
/// @param candidates  Not at p_W, not straight above or below it.
LocalStar CalcLocalStar(const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                        std::span<const StarCandidate> candidates, StarScratch& scratch);

}  // namespace nbs
