#include "services/reporter/run_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/reporter/svg_overlay.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A ball, scanned from the front (-y) by one path along x.
class PicturesOfARun : public ::testing::Test {
 protected:
  PicturesOfARun() : voxels_(MakeGrid()) {
    config_.grid = MakeGrid();
    config_.cell.sensor_body_S = {{{0, 0, -0.04}, 0.04}};
    ScanRecord scan;
    scan.path = {MakeLookPose({-0.1, -0.4, 0}, {0, 1, 0}, {1, 0, 0}),
                 MakeLookPose({0.1, -0.4, 0}, {0, 1, 0}, {1, 0, 0})};
    record_.scans.push_back(scan);
    model_W_ = MakeSphere(0.1f, 4);
    traces_.meshes_W.push_back(model_W_);
    ExecutedMotion motion;
    motion.states.push_back({0, 0, true, false, scan.path.X_WS_start, {}});
    traces_.motions.push_back(motion);
  }
  static GridShape MakeGrid() { return {Eigen::Vector3d::Constant(-0.15), 0.05, Eigen::Vector3i::Constant(6)}; }

  RunPictures Draw() const { return DrawRun(config_, record_, model_W_, voxels_, traces_); }

  RunConfig config_;
  RunRecord record_;
  TriangleMesh model_W_;
  VoxelGrid voxels_;
  RunTraces traces_;
};

TEST_F(PicturesOfARun, AScanHasItsNumberOnTheSideThatItLookedAt) {
  const RunPictures pictures = Draw();
  ASSERT_EQ(pictures.sides.size(), 4u);
  ASSERT_EQ(pictures.paths.size(), 4u);
  EXPECT_THAT(pictures.paths[0].overlay, HasSubstr(">1</text>"));
  EXPECT_THAT(pictures.paths[2].overlay, Not(HasSubstr(">1</text>")));
}

TEST_F(PicturesOfARun, RobotIsDrawnForEachScanThatWasExecuted) {
  EXPECT_EQ(Draw().scans.size(), 1u);
  EXPECT_EQ(Draw().scans[0].caption, "1: first, 0.20 m");
  traces_.motions.clear();
  EXPECT_TRUE(Draw().scans.empty());
}

TEST_F(PicturesOfARun, WithoutAMeshThereIsTheVoxelSpace) {
  model_W_ = {};
  traces_.meshes_W = {model_W_};
  const RunPictures pictures = Draw();
  EXPECT_TRUE(pictures.sides.empty());
  EXPECT_TRUE(pictures.scans.empty());
  EXPECT_EQ(pictures.voxels.size(), 2u);
}

TEST_F(PicturesOfARun, SidesShowTheModelThatTheRunLeaves) {
  const RunPictures before = Draw();
  model_W_ = MakeSphere(0.05f, 4);  // As if it had been made anew after the run.
  EXPECT_NE(Draw().sides[0].png, before.sides[0].png);
  EXPECT_EQ(Draw().scans[0].png, before.scans[0].png);
}

TEST_F(PicturesOfARun, SamePicturesEveryTime) {
  EXPECT_EQ(Draw().scans[0].png, Draw().scans[0].png);
  EXPECT_EQ(Draw().voxels[1].png, Draw().voxels[1].png);
}

TEST(NumberDiscs, KeepApartWhereTheirLinesAllow) {
  NumberDiscs discs;
  const PixelLine line = {{0, 0}, {50, 0}, {100, 0}};
  discs.Add(1, line, "red");
  discs.Add(2, line, "blue");
  EXPECT_THAT(discs.Draw(), HasSubstr("cx='0.0'"));
  EXPECT_THAT(discs.Draw(), HasSubstr("cx='100.0'"));
  EXPECT_EQ(NumberDiscs().Draw(), "");
}

TEST(ScanColor, RunsThroughHuesInOrder) {
  EXPECT_EQ(MakeScanColor(0, 1), MakeScanColor(0, 30));
  EXPECT_NE(MakeScanColor(0, 30), MakeScanColor(29, 30));
}

}  // namespace
}  // namespace nbs
