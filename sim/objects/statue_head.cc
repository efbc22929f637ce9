#include <cmath>

#include "common/geometry/directions.h"
#include "sim/objects/statue_parts.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// The head's own frame: origin in its middle, face towards -y; turned to the figure's left, bowed and tilted a little.
Pose MakeHeadPose() {
  Pose X = Pose::Identity();
  X.translation() = Vector3d(0, -5, 361);
  X.linear() = (Eigen::AngleAxisd(0.30, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.10, Vector3d::UnitX()) *
                Eigen::AngleAxisd(0.08, Vector3d::UnitY()))
                   .toRotationMatrix();
  return X;
}

void SculptEye(Sculptor& s, double side) {
  s.Ball({side * 15.5, -33.6, 2.0}, 8.6, {0.4});
  const Sculptor::Seam lid{1.2};
  s.Chain({{side * 7.5, -41.5, 1.5}, {side * 12.0, -42.6, 6.2}, {side * 18.0, -41.6, 6.6}, {side * 24.0, -36.0, 2.0}},
          {1.5, 1.9, 1.9, 1.4}, lid);
  s.Chain({{side * 7.5, -41.5, 1.0}, {side * 13.0, -42.0, -3.6}, {side * 19.0, -40.6, -3.4}, {side * 24.0, -36.0, 1.5}},
          {1.3, 1.5, 1.5, 1.3}, lid);
  s.CutBall({side * 14.6, -42.6, 2.2}, 2.0, {0.6});
  s.Chain({{side * 6.5, -42.5, 13.5}, {side * 15.0, -42.6, 16.0}, {side * 26.0, -34.5, 11.0}}, {1.8, 2.4, 1.8}, {6.0});
}

void SculptNoseAndMouth(Sculptor& s) {
  s.Limb({0, -41.0, 9.0}, 3.6, {0, -49.0, -8.5}, 5.4, {5.0});
  s.Ball({-5.6, -45.6, -9.6}, 3.7, {2.5});
  s.Ball({5.6, -45.6, -9.6}, 3.7, {2.5});
  s.CutBall({-3.0, -49.0, -14.0}, 1.8, {1.0});
  s.CutBall({3.0, -49.0, -14.0}, 1.8, {1.0});
  s.Egg({-4.4, -42.0, -21.0}, {7.4, 4.4, 3.0}, {2.0});
  s.Egg({4.4, -42.0, -21.0}, {7.4, 4.4, 3.0}, {2.0});
  s.Egg({0, -41.2, -27.4}, {8.2, 4.6, 3.3}, {2.0});
  s.CutLimb({0, -47.4, -24.0}, 1.2, {-10.5, -42.6, -23.0}, 1.0, {1.0});
  s.CutLimb({0, -47.4, -24.0}, 1.2, {10.5, -42.6, -23.0}, 1.0, {1.0});
  s.CutLimb({0, -48.0, -14.5}, 1.2, {0, -47.0, -19.0}, 1.6, {2.0});
  s.CutBall({-12.5, -41.0, -23.0}, 1.8, {2.5});
  s.CutBall({12.5, -41.0, -23.0}, 1.8, {2.5});
  s.CutLimb({-6, -45, -33.0}, 1.6, {6, -45, -33.0}, 1.6, {4.0});
}

void SculptEar(Sculptor& s, double side) {
  s.Egg({side * 40.5, 3, -3}, {4.6, 8.5, 13.0}, {2.0}, Vector3d(side * 0.12, 0.15, 1));
  s.CutEgg({side * 45.0, 0.5, -1}, {4.0, 5.2, 8.5}, {1.5}, Vector3d(side * 0.12, 0.15, 1));
  s.Ball({side * 40.0, 0, -14}, 4.2, {2.0});
}

/// A lock of hair: a spiral that winds up from the skull at `at`, `out` away from it. `turn` sets where it begins and
/// how it winds.
void SculptLock(Sculptor& s, const Vector3d& at, const Vector3d& out, double turn) {
  const Vector3d u = out.unitOrthogonal();
  const Vector3d v = out.cross(u) * (std::sin(3.3 * turn) > 0.0 ? 1.0 : -1.0);
  const Vector3d lean = 0.25 * (std::cos(1.3 * turn) * u + std::sin(1.7 * turn) * v);
  std::vector<Vector3d> points;
  std::vector<double> thickness;
  constexpr int kPoints = 8;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = static_cast<double>(i) / kPoints;
    const double angle = turn + 7.6 * t;
    const double radius = (8.4 + 1.2 * std::sin(5.1 * turn)) * (1.0 - 0.78 * t);
    points.push_back(at + radius * (std::cos(angle) * u + std::sin(angle) * v) + (-1.5 + 5.5 * t) * (out + lean));
    thickness.push_back(3.5 - 1.1 * t);
  }
  s.Chain(points, thickness, {0.8});
}

}  // namespace

void SculptHead(Sculptor& s) {
  s.SetFrame(MakeHeadPose());
  s.Egg({0, 5, 8}, {40.5, 45, 41}, {6});
  s.Egg({0, -9, -8}, {33.5, 34, 36}, {10});
  s.Egg({0, -22, 18}, {30, 20, 19}, {12});
  s.Ball({-18.5, -25, -17}, 16.5, {10});
  s.Ball({18.5, -25, -17}, 16.5, {10});
  s.Egg({0, -22, -38}, {17, 14, 9}, {8});
  s.Ball({0, -33.5, -35.5}, 8.5, {7});
  for (double side : {-1.0, 1.0}) s.CutEgg({side * 15.5, -45.5, 3.0}, {10.5, 9.0, 7.0}, {6});
  for (double side : {-1.0, 1.0}) SculptEye(s, side);
  SculptNoseAndMouth(s);
  for (double side : {-1.0, 1.0}) SculptEar(s, side);
  s.SetFrame(Pose::Identity());
}

void SculptHair(Sculptor& s) {
  s.SetFrame(MakeHeadPose());
  const Vector3d middle(0, 7, 9), radii(40.5, 44.5, 41.0);
  s.Egg({0, 10, 13}, {41.0, 43.5, 39.5}, {2.0});
  const std::vector<Vector3d> directions = MakeSphereDirections(116);
  for (size_t i = 0; i < directions.size(); ++i) {
    const Vector3d& d = directions[i];
    // The hairline: high over the forehead, low in the neck.
    if (d.z() > -0.02 - 0.60 * d.y()) SculptLock(s, middle + radii.cwiseProduct(d), d, 1.9 * static_cast<double>(i));
  }
  SculptLock(s, {-7, -32, 37}, {-0.2, -0.8, 0.6}, 0.4);
  SculptLock(s, {8, -32, 38}, {0.2, -0.8, 0.6}, 2.8);
  s.Chain({{1, -30, 45}, {2, -38, 39}, {-1, -41, 31}}, {4.0, 3.4, 2.0}, {1.5});
  s.SetFrame(Pose::Identity());
}

}  // namespace nbs
