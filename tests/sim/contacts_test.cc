#include "sim/contacts.h"

#include <gtest/gtest.h>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// A sensor above the sphere, with the window `gap` above its top.
Pose MakePoseAbove(double gap) { return MakeLookPose({0.0, 0.0, 0.1 + gap}, -Vector3d::UnitZ(), Vector3d::UnitY()); }

TEST(Contacts, AreTheStatesInWhichTheBodyMeetsTheSurface) {
  const TriangleScene sphere(MakeSphere(0.1f, 5));
  const std::vector<Sphere> body_S = {{{0.0, 0.0, -0.04}, 0.04}, {{0.0, 0.0, -0.12}, 0.04}};
  const std::vector<Pose> poses = {MakePoseAbove(0.2), MakePoseAbove(0.01), MakePoseAbove(-0.005), MakePoseAbove(0.03)};
  const Contacts contacts = FindContacts(sphere, body_S, poses);
  EXPECT_EQ(contacts.states, 4);
  EXPECT_EQ(contacts.touching, 1);
  EXPECT_NEAR(contacts.nearest_m, -0.005, 2e-4);
  EXPECT_NEAR(FindContacts(sphere, body_S, std::span(poses).first(2)).nearest_m, 0.01, 2e-4);
}

TEST(Contacts, OfAnyOfTheSpheresCount) {
  const TriangleScene sphere(MakeSphere(0.1f, 5));
  const std::vector<Pose> poses = {MakePoseAbove(0.05)};
  EXPECT_EQ(
      FindContacts(sphere, std::vector<Sphere>{{{0.0, 0.0, -0.04}, 0.04}, {{0.0, 0.0, 0.02}, 0.04}}, poses).touching,
      1);
}

TEST(Contacts, FarAwayAreNone) {
  const TriangleScene sphere(MakeSphere(0.1f, 3));
  const Contacts contacts = FindContacts(sphere, {{{0.0, 0.0, 0.0}, 0.04}}, std::vector<Pose>{MakePoseAbove(3.0)});
  EXPECT_EQ(contacts.touching, 0);
  EXPECT_EQ(contacts.nearest_m, kContactReach_m);
}

}  // namespace
}  // namespace nbs
