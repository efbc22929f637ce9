#include <array>
#include <cmath>
#include <numbers>

#include "sim/objects/statue_parts.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// Five toes in front of a foot whose ball is at `ball`, the big toe on the side `inner` (+1 or -1 along x).
void SculptToes(Sculptor& s, const Vector3d& ball, double inner) {
  constexpr std::array<double, 5> kForward = {15.0, 15.5, 14.0, 11.5, 8.5};
  constexpr std::array<double, 5> kRadius = {4.6, 3.4, 3.2, 3.0, 2.8};
  constexpr std::array<double, 5> kAside = {8.6, 2.6, -2.6, -7.2, -11.0};
  for (int i = 0; i < 5; ++i) {
    const Vector3d root = ball + Vector3d(inner * kAside[i] * 0.85, -3.0, 0.0);
    const Vector3d tip = ball + Vector3d(inner * kAside[i], -kForward[i], -3.2 + 0.15 * kRadius[i]);
    s.Limb(root, kRadius[i], tip, kRadius[i], {1.6});
  }
}

/// A hand: palm at `palm`, fingers that run along `along` and curl towards `curl`, thumb on the side of `thumb`.
void SculptHand(Sculptor& s, const Vector3d& palm, const Vector3d& along, const Vector3d& curl, const Vector3d& thumb) {
  const Vector3d side = along.cross(curl).normalized() * (along.cross(curl).dot(thumb) > 0.0 ? 1.0 : -1.0);
  s.Egg(palm, {10.5, 6.5, 12.5}, {5.0}, along);
  for (int i = 0; i < 4; ++i) {
    const double aside = 7.6 - 5.1 * i;
    const double length = (i == 1 || i == 2) ? 1.0 : 0.86;
    const Vector3d root = palm + 9.0 * along + aside * side;
    const Vector3d knuckle = root + length * (9.0 * along + 2.0 * curl) + 0.06 * aside * side;
    const Vector3d tip = knuckle + length * (5.0 * along + 7.5 * curl);
    s.Chain({root, knuckle, tip}, {3.6, 3.3, 2.7}, {1.3});
  }
  const Vector3d thumb_root = palm + 8.0 * side - 1.0 * along;
  s.Chain({thumb_root, thumb_root + 7.0 * side + 6.0 * along + 2.0 * curl,
           thumb_root + 8.0 * side + 14.0 * along + 5.0 * curl},
          {4.4, 3.7, 3.0}, {2.0});
}

}  // namespace

void SculptPlinth(Sculptor& s) {
  const Vector3d up = Vector3d::UnitZ(), x = Vector3d::UnitX();
  s.Place(Cylinder{97.0, 9.0, 2.5}, {0, 4, 9}, up, x, {});
  s.Place(Cylinder{83.0, 22.0, 1.5, 36, 3.0}, {0, 4, 22}, up, x, {1.0});
  s.Ring({0, 4, 18}, up, 86.0, 4.5, {1.5});
  s.Place(Cylinder{91.0, 4.5, 2.5}, {0, 4, 40}, up, x, {1.5});
  const Sculptor::Seam rock{5.0, 2.2, 9.0};
  s.Egg({2, 2, 42}, {78, 66, 11}, rock);
  s.Egg({-42, 34, 47}, {26, 24, 15}, rock);
  s.Egg({52, 28, 46}, {19, 24, 13}, rock);
  s.Egg({56, -24, 43}, {16, 15, 10}, rock);
}

void SculptLegs(Sculptor& s) {
  // The left leg carries the weight.
  s.Limb({25, 2, 170}, 32.5, {28, -5, 118}, 23.0, {10});
  s.Limb({28, -4, 112}, 20.5, {27, 6, 70}, 13.5, {7});
  s.Egg({29, 8, 94}, {16.5, 16, 22}, {8});
  s.Ball({28, -17, 113}, 9.5, {8});
  s.Ball({27, 10, 61}, 12.0, {6});
  s.Egg({27, -9, 60}, {14, 10, 23}, {6}, Vector3d(0.04, -1, -0.14));
  SculptToes(s, {27.5, -21, 57}, -1.0);
  // The right one is set forward and aside, bent at the knee.
  s.Limb({-19, 0, 168}, 31.5, {-34, -30, 124}, 22.0, {8});
  s.Limb({-34, -30, 118}, 19.5, {-41, -12, 74}, 13.0, {7});
  s.Egg({-38, -12, 98}, {15, 15, 21}, {8}, Vector3d(-0.15, 0.35, -1));
  s.Ball({-36, -43, 121}, 9.0, {8});
  s.Ball({-41, -7, 66}, 11.5, {6});
  s.Egg({-45, -25, 61}, {13.5, 9.5, 22}, {6}, Vector3d(-0.28, -1, -0.22));
  SculptToes(s, {-48, -37, 56}, 1.0);
  // Folds of a chubby child: behind the knees, at thighs and ankles.
  s.CutRing({26.5, -1, 146}, {0.05, -0.25, 1}, 30.5, 2.2, {4});
  s.CutRing({27, 5, 73}, {0, -0.15, 1}, 15.0, 1.6, {3});
  s.CutRing({-28, -16, 145}, {-0.3, -0.55, 1}, 29.0, 2.0, {4});
  s.CutRing({-41, -11, 77}, {-0.15, 0.35, 1}, 14.6, 1.5, {3});
}

void SculptTorso(Sculptor& s) {
  s.Egg({3, 3, 182}, {49, 39, 34}, {12});
  s.Egg({2, -9, 210}, {43, 37, 36}, {14});
  s.Egg({-1, 0, 254}, {46, 33, 42}, {16});
  s.Ball({-22, -19, 264}, 16.0, {12});
  s.Ball({20, -19, 262}, 16.0, {12});
  s.Ball({-23, -36, 259}, 2.2, {1.5});
  s.Ball({20, -36, 257}, 2.2, {1.5});
  s.Egg({-25, 24, 270}, {15, 9, 22}, {9});
  s.Egg({23, 24, 267}, {15, 9, 22}, {9});
  s.Ball({-18, 25, 174}, 28.0, {7});
  s.Ball({27, 25, 172}, 29.0, {5});
  s.CutLimb({1, 40, 196}, 4.0, {-1, 36, 285}, 3.0, {9});
  s.CutBall({1, -47, 205}, 3.6, {4});
  s.CutRing({2, -8, 231}, {0.02, 0.1, 1}, 43.5, 1.6, {5});
  s.Limb({-50, 3, 289}, 21.0, {48, 3, 283}, 21.0, {14});
  s.Limb({-2, 3, 292}, 21.0, {-1, 0, 322}, 18.0, {10});
  s.CutRing({-1, 0, 318}, {0.05, 0.3, 1}, 20.5, 1.4, {3});
}

void SculptArms(Sculptor& s) {
  // Right: raised, the bowl on its hand.
  s.Limb({-54, 3, 291}, 21.5, {-97, -8, 324}, 16.0, {9});
  s.Limb({-97, -9, 328}, 16.5, {-91, -20, 388}, 11.0, {5});
  s.Egg({-97, -11, 346}, {15.5, 15.0, 22}, {6}, Vector3d(0.1, -0.18, 1));
  s.CutRing({-92, -19, 385}, {0.1, -0.18, 1}, 12.6, 1.4, {2.5});
  s.CutRing({-79, -3, 311}, {0.8, 0.2, -0.6}, 19.6, 1.6, {3.5});
  SculptHand(s, {-90, -22, 404}, Vector3d(0.12, -0.45, 0.885).normalized(), Vector3d(0.1, -0.885, -0.46).normalized(),
             {1, 0, 0});
  // Left: the hand on the hip, the elbow out.
  s.Limb({50, 4, 282}, 20.5, {104, 20, 238}, 14.5, {8});
  s.Limb({104, 20, 236}, 14.5, {71, -14, 204}, 10.5, {3});
  s.Egg({92, 8, 226}, {13.5, 13.5, 19}, {5}, Vector3d(-0.58, -0.6, -0.56));
  s.CutRing({74, -11, 207}, {-0.58, -0.6, -0.56}, 12.0, 1.3, {2.5});
  SculptHand(s, {59, -22, 193}, Vector3d(-0.45, -0.62, -0.64).normalized(), Vector3d(-0.8, 0.2, 0.3).normalized(),
             {0, -0.3, 1});
}

void SculptBowl(Sculptor& s) {
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d middle(-88, -25, 468);
  s.Place(Bowl{52.0, 14.0, 5.5}, middle, up, Vector3d::UnitX(), {2});
  s.Ring(middle + Vector3d(0, 0, 15), up, 50.0, 4.2, {1});
  s.Ring(middle + Vector3d(0, 0, 2), up, 54.0, 2.0, {1});
  s.Ring(middle + Vector3d(0, 0, -47), up, 22.0, 3.5, {2});
  for (int i = 0; i < 18; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 18.0;
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    s.Chain({middle + 53.5 * out - 2.0 * up, middle + 47.5 * out - 25.0 * up, middle + 29.0 * out - 44.0 * up},
            {3.4, 2.8, 1.6}, {1.2});
  }
  // Fruit on a bed that fills the bottom.
  s.Egg(middle + Vector3d(0, 0, -33), {39, 39, 15}, {2.0});
  const Sculptor::Seam fruit{2.5};
  s.Ball(middle + Vector3d(-14, 12, -20), 18.0, fruit);
  s.Ball(middle + Vector3d(18, 12, -19), 17.0, fruit);
  s.Egg(middle + Vector3d(6, -20, -18), {14, 14, 19}, fruit, {0.9, 0.3, 0.5});
  s.Ball(middle + Vector3d(2, 6, -4), 15.0, fruit);
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.4 * i;
    const double radius = 3.2 * std::sqrt(static_cast<double>(i));
    s.Ball(middle + Vector3d(-27.0 + radius * std::cos(angle), -16.0 + radius * std::sin(angle),
                             -14.0 - 0.5 * radius + 1.5 * (i % 3)),
           5.6, fruit);
  }
}

}  // namespace nbs
