#include "common/kinematics/arm_body.h"

#include <gtest/gtest.h>

#include "common/kinematics/shape_distance.h"
#include "tests/common/kinematics/arms.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

Vector3d MakeRandomPoint(uint64_t seed, uint64_t number) {
  return {CalcUniform({seed, number, 0}) - 0.5, CalcUniform({seed, number, 1}) - 0.5,
          CalcUniform({seed, number, 2}) - 0.5};
}

TEST(ShapeDistance, OfLinesIsThatOfTheirNearestSamples) {
  for (int i = 0; i < 300; ++i) {
    const Vector3d a = MakeRandomPoint(1, i), b = MakeRandomPoint(2, i), c = MakeRandomPoint(3, i);
    const Vector3d d = i % 10 == 0 ? c : MakeRandomPoint(4, i);
    double sampled = 10.0;
    for (int s = 0; s <= 100; ++s) {
      for (int t = 0; t <= 100; ++t)
        sampled = std::min(sampled, (a + s * 0.01 * (b - a) - c - t * 0.01 * (d - c)).norm());
    }
    const double distance = CalcSegmentDistance(a, b, c, d);
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_GE(distance, sampled - 0.02);
    EXPECT_NEAR(distance, CalcSegmentDistance(d, c, a, b), 1e-9);
  }
}

TEST(ShapeDistance, OfLineAndBoxIsThatOfTheNearestSample) {
  const Vector3d half(0.1, 0.2, 0.05);
  for (int i = 0; i < 300; ++i) {
    const Vector3d a = MakeRandomPoint(5, i), b = MakeRandomPoint(6, i);
    double sampled = 10.0;
    for (int s = 0; s <= 1000; ++s) sampled = std::min(sampled, CalcBoxDistance(a + s * 0.001 * (b - a), half));
    EXPECT_NEAR(CalcSegmentBoxDistance(a, b, half), sampled, 1e-3);
    EXPECT_LE(CalcSegmentBoxDistance(a, b, half), sampled + 1e-12);
  }
  // Along a face, in a point, across.
  EXPECT_DOUBLE_EQ(CalcSegmentBoxDistance({-1, 0.5, 0}, {1, 0.5, 0}, half), 0.5 - half.y());
  EXPECT_DOUBLE_EQ(CalcSegmentBoxDistance({0, 0, 1}, {0, 0, 1}, half), 1.0 - half.z());
  EXPECT_EQ(CalcSegmentBoxDistance({-1, -1, -1}, {1, 1, 1}, half), 0.0);
}

TEST(ShapeDistance, OfBlockAndBoxIsThatOfTheirNearestPoints) {
  const Vector3d half(0.3, 0.2, 0.1);
  for (int i = 0; i < 300; ++i) {
    Block block{MakePose(2.0 * MakeRandomPoint(21, i), Eigen::Quaterniond(0.3, 0.8, 0.1 * i, 0.4).normalized()),
                {0.25, 0.1, 0.15}};
    // Alternating projections.
    Vector3d p = Vector3d::Zero(), q = p;
    for (int k = 0; k < 3000; ++k) {
      q = block.X_LC * Vector3d((block.X_LC.inverse() * p).cwiseMax(-block.half).cwiseMin(block.half));
      p = q.cwiseMax(-half).cwiseMin(half);
    }
    EXPECT_NEAR(CalcBlockBoxDistance(block, half), (p - q).norm(), 1e-4) << i;
  }
}

TEST(ShapeDistance, SpheresCoverTheirCapsuleAndReachNoFartherThanSaid) {
  const Capsule capsule{{0, 0, 0}, {0.3, 0.1, 0}, 0.08};
  const std::vector<Capsule> spheres = CoverCapsule(capsule, 0.004);
  for (const Capsule& sphere : spheres) EXPECT_LE(sphere.radius_m, capsule.radius_m + 0.004 + 1e-12);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = capsule.p_A + CalcUniform({7, static_cast<uint64_t>(i)}) * (capsule.p_B - capsule.p_A) +
                       capsule.radius_m * MakeRandomPoint(8, i).normalized();
    EXPECT_TRUE(std::any_of(spheres.begin(), spheres.end(),
                            [&](const Capsule& sphere) { return (p - sphere.p_A).norm() <= sphere.radius_m + 1e-12; }));
  }
}

TEST(ShapeDistance, CapsulesCoverTheirBox) {
  const Block block{MakePose({0.1, 0.2, 0.3}, Eigen::Quaterniond(0.8, 0.2, 0.4, 0.4)), {0.3, 0.1, 0.16}};
  const std::vector<Capsule> capsules = CoverBlock(block);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = block.X_LC * (2.0 * MakeRandomPoint(9, i)).cwiseProduct(block.half).eval();
    EXPECT_TRUE(std::any_of(capsules.begin(), capsules.end(), [&](const Capsule& c) {
      return CalcSegmentDistance(c.p_A, c.p_B, p, p) <= c.radius_m + 1e-9;
    }));
  }
}

Joints MakeJoints(double a1, double a2, double a3, double a4, double a5, double a6) {
  Joints q(6);
  q << a1, a2, a3, a4, a5, a6;
  return q;
}

double CalcSelf(const ArmModel& model, const Joints& q) {
  LinkPoses X_BL;
  CalcLinkPoses(model, q, X_BL);
  return ArmBody(model, {}).CalcSelfDistance(X_BL, 1.0);
}

TEST(ArmBody, Kr16IsFreeAtItsStartPoseAndTouchesItselfFoldedBack) {
  const ArmModel model = ReadKr16();
  EXPECT_GT(CalcSelf(model, MakeJoints(0, -1.57, 1.57, 0, 1.57, 0)), 0.0);
  // Elbow bent until the wrist is in the upper arm's foot.
  EXPECT_LT(CalcSelf(model, MakeJoints(0, -0.5, 2.68, 0, 2.2, 0)), 0.0);
}

TEST(ArmBody, NeighboursAreNotCompared) {
  const ArmBody body(ReadKr16(), {{{0, 0, 0.1}, {0, 0, 0.1}, 0.05}});
  EXPECT_EQ(body.parts().size(), 8u);
  for (const ArmBody::Pair& pair : body.pairs()) EXPECT_GE(pair.b - pair.a, 2);
  EXPECT_EQ(body.pairs().size(), 8u * 7u / 2u - 7u);
}

TEST(ArmBody, NoPointMovesFasterThanItsReachSays) {
  const ArmModel model = ReadKr16();
  const ArmBody body(model, {{{0, 0.1, 0.2}, {0, 0.1, 0.2}, 0.05}});
  for (int i = 0; i < 200; ++i) {
    const Joints q = MakeRandomJoints(model, 10, i);
    LinkPoses before;
    CalcLinkPoses(model, q, before);
    for (int k = 0; k < 6; ++k) {
      Joints moved = q;
      moved[k] += 1e-4;
      LinkPoses after;
      CalcLinkPoses(model, moved, after);
      for (size_t p = 0; p < body.parts().size(); ++p) {
        const ArmPart& part = body.parts()[p];
        for (const Capsule& sphere : part.spheres) {
          const double way = (after[part.link] * sphere.p_A - before[part.link] * sphere.p_A).norm();
          EXPECT_LE(way, 1e-4 * body.CalcReach(static_cast<int>(p), k) + 1e-12);
        }
      }
    }
  }
}

}  // namespace
}  // namespace nbs
