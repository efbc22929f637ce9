#include "services/planner/motion_planning/motion_planner.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "services/planner/motion_planning/collision_body.h"
#include "services/planner/motion_planning/flange_path.h"
#include "services/planner/motion_planning/swept_check.h"
#include "services/planner/motion_planning/timing.h"
#include "tests/services/planner/motion_planning/motion_cases.h"

namespace nbs {
namespace {

constexpr double kPi = 3.14159265358979323846;

const Pose kFacingTheBlock = MakeUpwardPath(0.0).X_WS_start;

MotionPlanner MakePlanner() { return MotionPlanner(MakeFreeRun()); }

/// Every bit of a trajectory, as text.
std::string ToBytes(const Trajectory& trajectory) {
  std::string bytes;
  const auto add = [&](const void* data, size_t size) {
    std::array<char, 3> hex{};
    for (size_t k = 0; k < size; ++k) {
      std::snprintf(hex.data(), hex.size(), "%02x", static_cast<const unsigned char*>(data)[k]);
      bytes += hex.data();
    }
  };
  for (const TrajectoryPoint& point : trajectory.points) {
    add(&point.time_us, sizeof point.time_us);
    add(&point.scanning, sizeof point.scanning);
    const Eigen::Matrix<double, 3, 4> X = point.X_WF.matrix().topRows<3>();
    add(X.data(), sizeof(double) * 12);
  }
  return bytes;
}

/// From the front of the block to a path behind it.
MotionPlanner::Result PlanBehindTheBlock(const MotionPlanner& planner) {
  return planner.Plan(MakeBlockWorld(), kFacingTheBlock, MakeUpwardPath(kPi), 42);
}

/// State of the flange at a time, as the robot interpolates.
Pose CalcStateAt(const Trajectory& trajectory, int64_t time_us) {
  size_t k = 0;
  while (k + 2 < trajectory.points.size() && trajectory.points[k + 1].time_us <= time_us) ++k;
  const TrajectoryPoint& a = trajectory.points[k];
  const TrajectoryPoint& b = trajectory.points[k + 1];
  return Interpolate(a.X_WF, b.X_WF,
                     static_cast<double>(time_us - a.time_us) / static_cast<double>(b.time_us - a.time_us));
}

TEST(MotionPlanner, GoesStraightWhereTheWayIsFree) {
  const ScanPath path = MakeUpwardPath(0.0);
  Pose X_now = path.X_WS_start;
  X_now.translation().y() += 0.1;
  const MotionPlanner::Result result = MakePlanner().Plan(MakeBlockWorld(), X_now, path, 1);
  EXPECT_EQ(result.verdict, Verdict::kReachable);
  ASSERT_EQ(result.trajectory.points.size(), 3u);
  EXPECT_EQ(result.trajectory.points[0].X_WF.matrix(), X_now.matrix());
  EXPECT_EQ(result.trajectory.points[1].X_WF.matrix(), path.X_WS_start.matrix());
  EXPECT_EQ(result.trajectory.points[2].X_WF.matrix(), path.X_WS_end.matrix());
}

TEST(MotionPlanner, StartsAtTheNearerEnd) {
  const ScanPath path = MakeUpwardPath(0.0);
  const MotionPlanner::Result result = MakePlanner().Plan(MakeBlockWorld(), path.X_WS_end, path, 1);
  EXPECT_EQ(result.path.X_WS_start.matrix(), path.X_WS_end.matrix());
  EXPECT_EQ(result.path.X_WS_end.matrix(), path.X_WS_start.matrix());
  EXPECT_EQ(result.trajectory.points.size(), 2u);
}

TEST(MotionPlanner, TakesTheRollThatIsNearer) {
  const ScanPath path = MakeUpwardPath(0.0);
  const Pose X_now = RollPath(path).X_WS_start;
  const MotionPlanner::Result result = MakePlanner().Plan(MakeBlockWorld(), X_now, path, 1);
  EXPECT_EQ(result.path.X_WS_start.matrix(), X_now.matrix());
}

TEST(MotionPlanner, GoesRoundTheBlock) {
  const MotionPlanner::Result result = PlanBehindTheBlock(MakePlanner());
  EXPECT_EQ(result.verdict, Verdict::kReachable);
  EXPECT_GE(result.trajectory.points.size(), 4u);
}

TEST(MotionPlanner, PathInTheBlockIsBlockedByAnObstacle) {
  ScanPath path = MakeUpwardPath(0.0);
  path.X_WS_start.translation().x() = 0.1;
  path.X_WS_end.translation().x() = 0.1;
  const MotionPlanner::Result result = MakePlanner().Plan(MakeBlockWorld(), kFacingTheBlock, path, 1);
  EXPECT_EQ(result.verdict, Verdict::kBlockedByObstacle);
  EXPECT_FALSE(result.found());
}

TEST(MotionPlanner, PathInUnknownSpaceIsBlockedByUnknown) {
  BoxWorld world;
  world.unknown.push_back(MakeBox({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const Pose X_far = MakePose({1, 0, 0}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(MakePlanner().Plan(world, X_far, MakeUpwardPath(0.0), 1).verdict, Verdict::kBlockedByUnknown);
}

TEST(MotionPlanner, AShellAroundTheSensorLeavesNoMotion) {
  BoxWorld world = MakeBlockWorld();
  const Pose X_now = MakePose({0, 0, 1.0}, Eigen::Quaterniond::Identity());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector3d middle = X_now.translation();
      middle[axis] += side * 0.25;
      Eigen::Vector3d half = Eigen::Vector3d::Constant(0.26);
      half[axis] = 0.01;
      world.occupied.emplace_back(middle - half, middle + half);
    }
  }
  const MotionPlanner::Result result = MakePlanner().Plan(world, X_now, MakeUpwardPath(0.0), 1);
  EXPECT_EQ(result.verdict, Verdict::kNoMotion);
  EXPECT_FALSE(result.found());
}

TEST(MotionPlanner, BlockedPartIsLeftOut) {
  BoxWorld world = MakeBlockWorld();
  world.occupied.push_back(MakeBox({0.3, -0.1, 0.15}, {0.6, 0.1, 0.2}));
  const MotionPlanner::Result result = MakePlanner().Plan(world, kFacingTheBlock, MakeUpwardPath(0.0), 1);
  EXPECT_EQ(result.verdict, Verdict::kPartly);
  EXPECT_TRUE(result.found());
  EXPECT_LT(result.path.length_m(), 0.29);
  EXPECT_GT(result.path.length_m(), 0.1);
}

TEST(MotionPlanner, StandingWithinItsMarginItFirstMovesAway) {
  BoxWorld world = MakeBlockWorld();
  Pose X_now = kFacingTheBlock;
  world.occupied.push_back(MakeBox({0.0, 0.135, -0.3}, {0.6, 0.2, 0.0}));
  const CollisionBody body(MakeDefaultSensorBody(), 0.02);
  X_now.translation().y() = 0.05;
  ASSERT_NE(body.FindTouch(world, X_now), Touch::kFree);
  const MotionPlanner::Result result = MakePlanner().Plan(world, X_now, MakeUpwardPath(0.0), 1);
  ASSERT_TRUE(result.found());
  EXPECT_EQ(result.trajectory.points[0].X_WF.matrix(), X_now.matrix());
  EXPECT_EQ(body.FindTouch(world, result.trajectory.points[1].X_WF), Touch::kFree);
}

TEST(MotionPlanner, TheTableIsAnObstacle) {
  RunConfig config = MakeFreeRun();
  config.cell.table_z_m = -0.4;
  EXPECT_EQ(MotionPlanner(config).CheckPath(BoxWorld{}, MakeUpwardPath(0.0)).verdict, Verdict::kReachable);
  config.cell.table_z_m = -0.2;
  EXPECT_EQ(MotionPlanner(config).CheckPath(BoxWorld{}, MakeUpwardPath(0.0)).verdict, Verdict::kPartly);
  config.cell.table_z_m = 0.3;
  EXPECT_EQ(MotionPlanner(config).CheckPath(BoxWorld{}, MakeUpwardPath(0.0)).verdict, Verdict::kBlockedByObstacle);
}

TEST(MotionPlanner, CheckAndPlanAgreeOnTheVerdict) {
  const MotionPlanner planner = MakePlanner();
  for (uint64_t k = 0; k < 50; ++k) {
    const ScanPath path = {MakeRandomPose(3, k, 0.4), MakeRandomPose(4, k, 0.4)};
    const Verdict checked = planner.CheckPath(MakeBlockWorld(), path).verdict;
    const Verdict planned = planner.Plan(MakeBlockWorld(), kFacingTheBlock, path, k).verdict;
    EXPECT_TRUE(planned == checked || planned == Verdict::kNoMotion) << k;
  }
}

TEST(MotionPlanner, ThePartOfACheckIsReachableItself) {
  RunConfig config = MakeFreeRun();
  config.cell.X_FS =
      MakePose({0.05, -0.02, 0.12}, Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitX())));
  const MotionPlanner planner(config);
  int parts = 0;
  for (uint64_t k = 0; k < 2000; ++k) {
    const ScanPath path = {MakeRandomPose(3, k, 0.4), MakeRandomPose(4, k, 0.4)};
    const PathCheck check = planner.CheckPath(MakeBlockWorld(), path);
    if (check.verdict != Verdict::kPartly) continue;
    ++parts;
    EXPECT_EQ(planner.CheckPath(MakeBlockWorld(), check.path).verdict, Verdict::kReachable) << k;
  }
  EXPECT_GT(parts, 500);
}

TEST(MotionPlanner, RefusesUnknownRobotsAndPosesThatAreNone) {
  RunConfig config = MakeFreeRun();
  config.cell.robot = "walker";
  EXPECT_THROW(MotionPlanner{config}, std::invalid_argument);
  Pose X_now = kFacingTheBlock;
  X_now.linear() *= 2.0;
  EXPECT_THROW((void)MakePlanner().Plan(BoxWorld{}, X_now, MakeUpwardPath(0.0), 1), std::invalid_argument);
}

TEST(MotionPlanner, SameRequestGivesTheSameBytesWhateverCameBefore) {
  const MotionPlanner planner = MakePlanner();
  const std::string first = ToBytes(PlanBehindTheBlock(planner).trajectory);
  (void)planner.Plan(MakeBlockWorld(), kFacingTheBlock, MakeUpwardPath(2.5), 5);
  EXPECT_EQ(ToBytes(PlanBehindTheBlock(planner).trajectory), first);
  EXPECT_EQ(ToBytes(PlanBehindTheBlock(MakePlanner()).trajectory), first);
}

// Prints them too where the test below runs it in a process of its own.
TEST(MotionPlannerChild, RequestHasBytes) {
  const std::string bytes = ToBytes(PlanBehindTheBlock(MakePlanner()).trajectory);
  EXPECT_FALSE(bytes.empty());
  if (std::getenv("NBS_PRINT_BYTES") != nullptr) std::printf("bytes %s\n", bytes.c_str());
}

TEST(MotionPlanner, SameRequestGivesTheSameBytesInAnotherProcess) {
  std::array<char, 4096> self{};
  ASSERT_GT(readlink("/proc/self/exe", self.data(), self.size() - 1), 0);
  const std::string command =
      "NBS_PRINT_BYTES=1 '" + std::string(self.data()) + "' --gtest_filter=MotionPlannerChild.*";
  FILE* child = popen(command.c_str(), "r");
  ASSERT_NE(child, nullptr);
  std::string output;
  std::array<char, 4096> buffer{};
  for (size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), child)) > 0;) output.append(buffer.data(), n);
  EXPECT_EQ(pclose(child), 0);
  const std::string wanted = "bytes " + ToBytes(PlanBehindTheBlock(MakePlanner()).trajectory) + "\n";
  EXPECT_NE(output.find(wanted), std::string::npos);
}

/// Random requests around the block, with the sensor off the flange's origin for the odd ones.
class MotionPlannerLaw : public testing::TestWithParam<uint64_t> {
 protected:
  void SetUp() override {
    const uint64_t k = GetParam();
    if (k % 2 == 1) {
      config_.cell.X_FS =
          MakePose({0.05, -0.02, 0.12}, Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitX())));
    }
    world_.occupied.push_back(MakeBox({-0.6, -0.05, 0.2}, {0.6, 0.05, 0.25}));
    path_ = MakeUpwardPath(2.0 * kPi * CalcUniform({k, 1}));
    path_.X_WS_end.linear() =
        Eigen::AngleAxisd(0.6 * CalcUniform({k, 2}), path_.X_WS_end.linear().col(0)) * path_.X_WS_end.linear();
    X_WS_now_ = MakeUpwardPath(2.0 * kPi * CalcUniform({k, 3})).X_WS_start;
    result_ = MotionPlanner(config_).Plan(world_, X_WS_now_, path_, k);
  }

  CollisionBody MakeBody() const {
    return {MoveSpheres(config_.cell.X_FS, MakeDefaultSensorBody()), config_.cell.body_margin_m};
  }

  RunConfig config_ = MakeFreeRun();
  BoxWorld world_ = MakeBlockWorld();
  ScanPath path_;
  Pose X_WS_now_ = Pose::Identity();
  MotionPlanner::Result result_;
};

TEST_P(MotionPlannerLaw, EveryMillisecondKeepsTheMargin) {
  ASSERT_TRUE(result_.found());
  const CollisionBody body = MakeBody();
  for (int64_t t = 0; t <= result_.trajectory.points.back().time_us; t += 1000) {
    ASSERT_GE(body.CalcSlack(world_, CalcStateAt(result_.trajectory, t)), -kSweepTolerance / 2.0 - 1e-9) << t;
  }
}

TEST_P(MotionPlannerLaw, StartsWhereTheSensorIsAndEndsWithTheScanPath) {
  ASSERT_TRUE(result_.found());
  const auto& points = result_.trajectory.points;
  EXPECT_TRUE((points.front().X_WF * config_.cell.X_FS).isApprox(X_WS_now_, 1e-12));
  EXPECT_TRUE((points.back().X_WF * config_.cell.X_FS).isApprox(result_.path.X_WS_end, 1e-12));
  const auto scan =
      std::find_if(points.begin(), points.end(), [](const TrajectoryPoint& point) { return point.scanning; });
  ASSERT_NE(scan, points.end());
  EXPECT_TRUE((scan->X_WF * config_.cell.X_FS).isApprox(result_.path.X_WS_start, 1e-12));
  EXPECT_EQ(scan->time_us % 40000, 0);
  EXPECT_TRUE(std::all_of(scan, points.end() - 1, [](const TrajectoryPoint& point) { return point.scanning; }));
  EXPECT_FALSE(points.back().scanning);
}

TEST_P(MotionPlannerLaw, NoSpeedExceedsItsLimit) {
  ASSERT_TRUE(result_.found());
  const auto& points = result_.trajectory.points;
  for (size_t k = 0; k + 1 < points.size(); ++k) {
    const double seconds = static_cast<double>(points[k + 1].time_us - points[k].time_us) * 1e-6;
    ASSERT_GT(seconds, 0.0);
    const Pose X_WS_a = points[k].X_WF * config_.cell.X_FS;
    const Pose X_WS_b = points[k + 1].X_WF * config_.cell.X_FS;
    EXPECT_LE((points[k + 1].X_WF.translation() - points[k].X_WF.translation()).norm() / seconds, 0.25 * (1 + 1e-9));
    EXPECT_LE(CalcAngleBetween(points[k].X_WF, points[k + 1].X_WF) / seconds, 0.8 * (1 + 1e-9));
    if (points[k].scanning) {
      EXPECT_LE((X_WS_b.translation() - X_WS_a.translation()).norm() / seconds, 0.05 * (1 + 1e-6));
      EXPECT_LE((points[k + 1].X_WF.translation() - points[k].X_WF.translation()).norm() / seconds, 0.05 * (1 + 1e-6));
    }
  }
}

TEST_P(MotionPlannerLaw, SameSeedGivesTheSameBytes) {
  EXPECT_EQ(ToBytes(MotionPlanner(config_).Plan(world_, X_WS_now_, path_, GetParam()).trajectory),
            ToBytes(result_.trajectory));
}

INSTANTIATE_TEST_SUITE_P(RandomRequests, MotionPlannerLaw, testing::Range<uint64_t>(1, 41));

TEST(MotionPlanner, MotionOfMorePointsThanAMessageHoldsIsNone) {
  // The sensor turns on its way, 200 m off the flange, whose way is then cut into hundreds of pieces.
  ScanPath path = MakeUpwardPath(0.0);
  path.X_WS_end.linear() = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitY()) * path.X_WS_end.linear();
  RunConfig config = MakeFreeRun();
  const BoxWorld nothing;
  EXPECT_TRUE(MotionPlanner(config).Plan(nothing, path.X_WS_start, path, 1).found());
  config.cell.X_FS.translation().z() = 200.0;
  const MotionPlanner::Result result = MotionPlanner(config).Plan(nothing, path.X_WS_start, path, 1);
  EXPECT_EQ(result.verdict, Verdict::kNoMotion);
  EXPECT_FALSE(result.found());
}

}  // namespace
}  // namespace nbs
