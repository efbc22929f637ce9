#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace nbs {

struct RoofSettings {
  float reach_m = 0.010f;          ///< Tangents further off have no weight.
  float same_angle_rad = 0.15f;    ///< Tangents of one plane turn from each other by no more than this
  float same_height_m = 0.0004f;   ///< and lie no further above or below.
  size_t least_tangents = 3;       ///< Fewer make no plane.
  float least_angle_rad = 0.8f;    ///< Between two planes; what bends less is no ridge.
  float most_overlap_m = 0.0003f;  ///< No tangent of one plane lies further above another.
};

/// The surface passes through p_W across normal_W.
struct Tangent {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();       ///< Metres.
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< Unit, outwards.
};

/// Two or three planes that meet in ridges which stand out, as seen from a point near by: the surface of what lies
/// below all of them.
class Roof {
 public:
  /// A point of a ridge, or a corner.
  struct Feature {
    Tangent tangent;                                    ///< The normal is the mean of those of the planes.
    Eigen::Vector3f along_W = Eigen::Vector3f::Zero();  ///< Unit, along the ridge; zero at a corner.
    bool IsCorner() const { return along_W.isZero(); }
  };

  /// Groups the tangents, each time about the nearest that is left; the first three groups that are large enough give a
  /// plane each, its tangents weighted by nearness to p_W.
  ///
  /// @param tangents  Of smooth parts of the surface.
  /// @returns Nothing unless there are at least two planes and the tangents of each lie below the others.
  static std::optional<Roof> Fit(std::span<const Tangent> tangents, const Eigen::Vector3f& p_W,
                                 const RoofSettings& settings);

  /// Height of p_W above the roof, metres; negative below.
  float CalcHeight(const Eigen::Vector3f& p_W) const;

  /// The point moved onto the plane that it is highest above, with the normal of that.
  Tangent Project(const Eigen::Vector3f& p_W) const;

  /// Where three planes meet, if they do.
  std::optional<Feature> FindCorner() const;

  /// For each pair of planes the point of their ridge that is nearest to p_W, if it lies on the roof.
  std::vector<Feature> FindFeet(const Eigen::Vector3f& p_W) const;

  /// False above the roof, where one plane cuts off the ridge of two others.
  bool IsOn(const Eigen::Vector3f& p_W) const;

 private:
  struct Plane {
    Eigen::Vector3f normal_W, p_W;
    float CalcHeight(const Eigen::Vector3f& q_W) const { return normal_W.dot(q_W - p_W); }
  };

  static Plane MakePlane(std::span<const Tangent> group, const Eigen::Vector3f& p_W, float reach_m);
  bool LiesBelowOthers(size_t plane, std::span<const Tangent> group, const RoofSettings& settings) const;
  size_t FindTop(const Eigen::Vector3f& p_W) const;

  std::vector<Plane> planes_;
};

}  // namespace nbs
