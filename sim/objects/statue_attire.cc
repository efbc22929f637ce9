#include <cmath>
#include <numbers>

#include "sim/objects/statue_parts.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// A twisted strand of cloth around the hips: higher on the figure's left, phase of the twist in radians.
void SculptStrand(Sculptor& s, double phase) {
  std::vector<Vector3d> points;
  std::vector<double> radii;
  constexpr int kPoints = 40;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    const double twist = 7.0 * angle + phase;
    const double radius = 1.0 + 0.055 * std::cos(twist);
    const auto square = [](double c) { return std::copysign(std::pow(std::abs(c), 0.75), c); };
    points.emplace_back(3.0 + 55.0 * radius * square(std::cos(angle)), 8.0 + 50.0 * radius * square(std::sin(angle)),
                        177.0 + 7.0 * std::cos(angle) + 4.0 * std::sin(twist));
    radii.push_back(6.0 + 0.8 * std::sin(3.0 * angle + phase));
  }
  s.Chain(points, radii, {1.5});
}

/// One flat feather from its root along a direction; `across` is the wing's normal.
void SculptFeather(Sculptor& s, const Vector3d& root, const Vector3d& along, const Vector3d& normal, double length,
                   double width) {
  const Vector3d direction = along.normalized();
  const Vector3d side = normal.cross(direction).normalized();
  s.Place(Ellipsoid{{width, 3.4, 0.5 * length}}, root + 0.46 * length * direction, direction, side, {0.6});
  s.Limb(root + 2.6 * normal, 1.6, root + 0.86 * length * direction + 2.6 * normal, 0.9, {0.8});
}

void SculptWing(Sculptor& s, double side) {
  const auto at = [side](double x, double y, double z) { return Vector3d(side * x, y, z); };
  const Vector3d root = at(17, 32, 270), bend = at(47, 56, 318), tip = at(84, 66, 326);
  const Vector3d normal = at(-0.35, 0.93, 0.1).normalized();
  for (int i = 0; i < 8; ++i) {
    const double t = i / 7.0;
    const Vector3d start = bend + t * (tip - bend) + (i % 2 == 0 ? 1.2 : -1.2) * normal;
    SculptFeather(s, start, at(0.10 + 0.75 * t, 0.12, -1.0 + 0.35 * t), normal, 92.0 - 26.0 * t, 7.4);
  }
  for (int i = 0; i < 5; ++i) {
    const double t = i / 5.0;
    const Vector3d start = root + t * (bend - root) + (i % 2 == 0 ? 1.2 : -1.2) * normal;
    SculptFeather(s, start, at(0.12 + 0.05 * t, 0.25 - 0.1 * t, -1.0), normal, 56.0 + 30.0 * t, 7.8);
  }
  for (int i = 0; i < 11; ++i) {
    const double t = i / 10.0;
    const Vector3d start =
        (t < 0.5 ? Vector3d(root + 2.0 * t * (bend - root)) : Vector3d(bend + (2.0 * t - 1.0) * (tip - bend)));
    SculptFeather(s, start + (i % 2 == 0 ? 4.6 : 3.4) * normal, at(0.10 + 0.5 * t, 0.15, -1.0 + 0.3 * t), normal, 36.0,
                  6.2);
  }
  s.Chain({root + at(-8, -10, -10), root, bend, tip}, {9.0, 8.0, 6.0, 4.0}, {3.0});
}

}  // namespace

void SculptCloth(Sculptor& s) {
  SculptStrand(s, 0.0);
  SculptStrand(s, std::numbers::pi);
  // The fall of cloth behind the right leg down to the rock, and the end that is drawn over the loins.
  s.Place(Cloth{40.0, 70.0, 6.5, 0.55, 7.5, 4, -6.0, -5.0}, {-44, 44, 116}, Vector3d(0.14, -0.12, 1).normalized(),
          Vector3d(1, 0.55, 0), {2.5});
  s.Place(Cloth{27.0, 24.0, 6.0, 1.3, 3.6, 3, 6.0, -2.0}, {2, -38, 160}, Vector3d(0.08, -0.20, 1).normalized(),
          Vector3d(1, 0.04, 0), {3.0});
  s.Egg({2, -26, 166}, {24, 13, 18}, {6.0});
  s.Ball({-45, 20, 180}, 12.0, {5});
  s.CutRing({-45, 20, 180}, {0.6, 0.5, 0.6}, 12.0, 1.5, {2});
}

void SculptWings(Sculptor& s) {
  for (double side : {-1.0, 1.0}) SculptWing(s, side);
}

}  // namespace nbs
