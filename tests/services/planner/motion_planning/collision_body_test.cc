#include "services/planner/motion_planning/collision_body.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

CollisionBody MakeBall() { return {{{{0.1, 0.0, 0.0}, 0.05}}, 0.02}; }

TEST(CollisionBody, IsFreeDownToItsMargin) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.17, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(MakeBall().FindTouch(world, MakePose({-0.001, 0, 0}, Eigen::Quaterniond::Identity())), Touch::kFree);
  EXPECT_EQ(MakeBall().FindTouch(world, MakePose({0.001, 0, 0}, Eigen::Quaterniond::Identity())), Touch::kOccupied);
}

TEST(CollisionBody, MovesItsSpheresWithThePose) {
  BoxWorld world;
  world.occupied.push_back(MakeBox({0.17, -1, -1}, {1, 1, 1}));
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(MakeBall().CalcSlack(world, MakePose({0, 0, 0}, quarter)), 0.1, 1e-12);
}

TEST(CollisionBody, TellsUnknownFromOccupied) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({0.16, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(MakeBall().FindTouch(world, Pose::Identity()), Touch::kUnknown);
}

TEST(CollisionBody, ReportsOccupiedWhereItTouchesBoth) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({0.14, -1, -1}, {1, 1, 1}));
  world.occupied.push_back(MakeBox({-1, -1, -1}, {0.04, 1, 1}));
  EXPECT_EQ(MakeBall().FindTouch(world, Pose::Identity()), Touch::kOccupied);
}

TEST(CollisionBody, BoundHoldsEverySphere) {
  const CollisionBody body(MakeDefaultSensorBody(), 0.02);
  for (const Sphere& sphere : body.spheres_B()) {
    EXPECT_LE((sphere.center - body.bound_B().center).norm() + sphere.radius_m, body.bound_B().radius_m + 1e-12);
  }
}

TEST(CollisionBody, RefusesNoSpheresAndBadNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CollisionBody({}, 0.02), std::invalid_argument);
  EXPECT_THROW(CollisionBody({{{0, 0, 0}, 0.0}}, 0.02), std::invalid_argument);
  EXPECT_THROW(CollisionBody({{{0, nan, 0}, 0.1}}, 0.02), std::invalid_argument);
  EXPECT_THROW(CollisionBody({{{0, 0, 0}, 0.1}}, nan), std::invalid_argument);
}

TEST(DefaultSensorBody, NoSphereReachesInFrontOfTheEmitter) {
  for (const Sphere& sphere : MakeDefaultSensorBody()) EXPECT_LE(sphere.center.z() + sphere.radius_m, 0.0);
}

TEST(DefaultSensorBody, EveryPointOfTheHousingIsWithinTwentyMillimetresOfASphere) {
  for (double x = -0.06; x <= 0.0601; x += 0.01) {
    for (double y = -0.10; y <= 0.1001; y += 0.01) {
      for (double z = -0.10; z <= 0.0001; z += 0.01) {
        double distance = 1.0;
        for (const Sphere& sphere : MakeDefaultSensorBody()) {
          distance = std::min(distance, (Eigen::Vector3d(x, y, z) - sphere.center).norm() - sphere.radius_m);
        }
        ASSERT_LE(distance, 0.02) << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(MoveSpheres, TakesCentresIntoTheFlangeFrame) {
  const Pose X_FS =
      MakePose({0, 0, 0.1}, Eigen::Quaterniond(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitX())));
  const std::vector<Sphere> spheres_F = MoveSpheres(X_FS, {{{0, 0, 0.2}, 0.03}});
  EXPECT_TRUE(spheres_F[0].center.isApprox(Eigen::Vector3d(0, -0.2, 0.1), 1e-12));
  EXPECT_EQ(spheres_F[0].radius_m, 0.03);
}

TEST(AboveTable, EverythingBelowTheTopIsOccupied) {
  const BoxWorld empty;
  const AboveTable table(empty, -0.1);
  EXPECT_EQ(table.CalcObstacleDistance({0, 0, -0.2}), 0.0);
  EXPECT_NEAR(table.CalcUnknownDistance({0, 0, 0.05}), 0.15, 1e-12);
  EXPECT_EQ(table.CalcUnknownDistance({0, 0, 2.0}), 0.3);
}

}  // namespace
}  // namespace nbs
