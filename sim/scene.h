#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// Lines of sight from or to a point of a surface stop this far off it.
inline constexpr double kSurfaceSkip_m = 1e-4;

/// A half-line in W.
struct Ray {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();           ///< Origin, metres.
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();  ///< Unit length.
};

/// Where a ray first meets the scene.
struct RayHit {
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t triangle = kNone;  ///< Number of the triangle; kNone: the ray meets nothing.
  double distance_m = 0.0;    ///< From the ray's origin.
  Eigen::Vector3d normal_W =
      Eigen::Vector3d::Zero();  ///< Geometric normal, unit length, out of the counter-clockwise side.

  bool hit() const { return triangle != kNone; }
};

/// The point of the scene that is closest to a given one.
struct ClosestPoint {
  uint32_t triangle = 0;
  double distance_m = 0.0;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< Geometric normal of the triangle.
};

/// Ray casting and closest points on a triangle mesh (Embree, Wald et al., ACM Trans. Graph. 33(4), 2014,
/// DOI 10.1145/2601097.2601199).
///
/// Embree is held to one instruction set, one thread and its robust mode, so that equal calls give equal bits on every
/// x86-64-v2 machine. A triangle without area is never met. Const methods may be called from several threads.
class TriangleScene {
 public:
  /// Copies the mesh. A mesh without triangles makes a scene that nothing meets.
  ///
  /// @throws std::invalid_argument if a triangle names a vertex that does not exist or a coordinate is not finite.
  explicit TriangleScene(const TriangleMesh& mesh_W);
  ~TriangleScene();
  TriangleScene(TriangleScene&&) noexcept;
  TriangleScene& operator=(TriangleScene&&) noexcept;

  /// First triangle, from either side, on each ray within [0, reach_m]; hits[i] belongs to rays[i]. Fastest when
  /// neighbours in the list are nearly parallel.
  ///
  /// @pre reach_m > 0.
  std::vector<RayHit> CastRays(std::span<const Ray> rays, double reach_m) const;

  /// One ray alone.
  RayHit CastRay(const Ray& ray, double reach_m) const;

  /// A straight line of sight between two points.
  struct Segment {
    Eigen::Vector3d p_WA = Eigen::Vector3d::Zero();
    Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  };

  /// For each segment 1 if the scene meets it, else 0. The first `skip_m` from A do not count, so that A may lie on the
  /// surface; nor does a segment that is not longer than skip_m.
  std::vector<uint8_t> FindBlocked(std::span<const Segment> segments, double skip_m) const;

  /// Closest point of the scene within `radius_m` of p_W; between triangles at the same distance the lower number wins.
  /// Computed in double.
  std::optional<ClosestPoint> FindClosest(const Eigen::Vector3d& p_W, double radius_m) const;

  /// Like FindClosest, among the triangles whose normal makes an angle with cosine >= min_cosine to the unit vector
  /// normal_W.
  std::optional<ClosestPoint> FindClosestFacing(const Eigen::Vector3d& p_W, double radius_m,
                                                const Eigen::Vector3d& normal_W, double min_cosine) const;

  /// Distance of a triangle abc from some solid, metres.
  using SolidDistance =
      std::function<double(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& c_W)>;

  /// Smallest distance of a solid from the scene; nullopt if no triangle is nearer than enough_m.
  ///
  /// @param p_W      A point such that all of the solid lies within reach_m of it.
  /// @param distance  May be negative where the triangle reaches into the solid, by how deep.
  std::optional<double> FindDistance(const Eigen::Vector3d& p_W, double reach_m, double enough_m,
                                     const SolidDistance& distance) const;

  /// True if the point sees the inside of the scene in all six directions of the axes: it lies in a closed mesh.
  bool IsInside(const Eigen::Vector3d& p_W) const;

  /// Around all triangles.
  const Eigen::AlignedBox3d& box_W() const { return box_W_; }

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  Eigen::AlignedBox3d box_W_;
};

}  // namespace nbs
