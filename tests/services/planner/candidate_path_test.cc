#include "services/planner/candidate_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nbs {
namespace {

const PathLimits kLimits;

Strip MakeStrip() {
  return {.p_W = {0.1, 0.2, 0.3},
          .normal_W = Eigen::Vector3d(0.2, -0.1, 1.0),
          .along_W = Eigen::Vector3d(1.0, 1.0, 0.3),
          .extent_m = 0.2};
}

Eigen::Vector3d CalcMiddle(const ScanPath& path) {
  return 0.5 * (path.X_WS_start.translation() + path.X_WS_end.translation());
}

TEST(CandidatePath, StraightLookMeetsTheMiddleAtTheStandoffAlongTheNormal) {
  const Strip strip = MakeStrip();
  const ScanPath path = MakeStripPath(strip, {}, 0.325, kLimits);
  const Eigen::Vector3d view_W = path.X_WS_start.linear().col(2);
  EXPECT_NEAR((CalcMiddle(path) + 0.325 * view_W - strip.p_W).norm(), 0.0, 1e-12);
  EXPECT_NEAR(view_W.dot(strip.normal_W.normalized()), -1.0, 1e-12);
  EXPECT_NEAR(path.length_m(), 0.2, 1e-12);
}

TEST(CandidatePath, ScanDirectionIsThatOfThePathAndTheStripeLiesAcross) {
  const ScanPath path = MakeStripPath(MakeStrip(), {}, 0.325, kLimits);
  const Eigen::Vector3d way = (path.X_WS_end.translation() - path.X_WS_start.translation()).normalized();
  EXPECT_NEAR(path.X_WS_start.linear().col(1).dot(way), 1.0, 1e-12);
  EXPECT_NEAR(path.X_WS_start.linear().col(0).dot(way), 0.0, 1e-12);
  EXPECT_TRUE(IsRigid(path.X_WS_start) && IsRigid(path.X_WS_end));
}

TEST(CandidatePath, TiltedLookStillMeetsTheMiddleAtTheStandoff) {
  const Strip strip = MakeStrip();
  for (const Tilt& tilt : {Tilt{0.5, 0.0}, Tilt{-0.9, 0.0}, Tilt{0.0, 0.6}, Tilt{0.4, -0.4}}) {
    const ScanPath path = MakeStripPath(strip, tilt, 0.25, kLimits);
    const Eigen::Vector3d view_W = path.X_WS_start.linear().col(2);
    EXPECT_NEAR((CalcMiddle(path) + 0.25 * view_W - strip.p_W).norm(), 0.0, 1e-12);
    const double expected = std::cos(tilt.about_along_rad) * std::cos(tilt.about_across_rad);
    EXPECT_NEAR(-view_W.dot(strip.normal_W.normalized()), expected, 1e-12);
  }
}

TEST(CandidatePath, LengthIsClampedToTheLimits) {
  Strip strip = MakeStrip();
  strip.extent_m = 0.0;
  EXPECT_NEAR(MakeStripPath(strip, {}, 0.325, kLimits).length_m(), kLimits.min_m, 1e-12);
  strip.extent_m = 3.0;
  EXPECT_NEAR(MakeStripPath(strip, {}, 0.325, kLimits).length_m(), kLimits.max_m, 1e-12);
}

TEST(CandidatePath, PathParallelToTheNormalIsRefused) {
  Strip strip = MakeStrip();
  strip.along_W = -2.0 * strip.normal_W;
  EXPECT_THROW(MakeStripPath(strip, {}, 0.325, kLimits), std::invalid_argument);
  strip.normal_W.setZero();
  EXPECT_THROW(MakeStripPath(strip, {}, 0.325, kLimits), std::invalid_argument);
}

TEST(CandidatePath, ExtendedStripCoversTheBoxAndTheOldStrip) {
  const Eigen::AlignedBox3d box_W(Eigen::Vector3d(0.0, -0.1, 0.0), Eigen::Vector3d(0.2, 0.1, 0.5));
  const Strip strip{.p_W = {0.2, 0.0, 0.1},
                    .normal_W = Eigen::Vector3d::UnitX(),
                    .along_W = Eigen::Vector3d::UnitZ(),
                    .extent_m = 0.1};
  const Strip extended = ExtendToBox(strip, box_W, 0.02, kLimits);
  EXPECT_NEAR(extended.extent_m, 0.54, 1e-12);
  EXPECT_NEAR((extended.p_W - Eigen::Vector3d(0.2, 0.0, 0.25)).norm(), 0.0, 1e-12);
}

TEST(CandidatePath, ExtendedStripThatCannotCoverTheBoxStillCoversTheOldStrip) {
  const Eigen::AlignedBox3d box_W(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.2, 0.2, 2.0));
  const Strip strip{.p_W = {0.2, 0.1, 0.1},
                    .normal_W = Eigen::Vector3d::UnitX(),
                    .along_W = Eigen::Vector3d::UnitZ(),
                    .extent_m = 0.1};
  const Strip extended = ExtendToBox(strip, box_W, 0.02, kLimits);
  EXPECT_NEAR(extended.extent_m, kLimits.max_m, 1e-12);
  EXPECT_LE(extended.p_W.z() - 0.5 * extended.extent_m, 0.05 + 1e-12);
  EXPECT_GE(extended.p_W.z() + 0.5 * extended.extent_m, 0.15);
}

TEST(CandidatePath, PathDrivenBackwardsIsAlike) {
  const ScanPath path = MakeStripPath(MakeStrip(), {}, 0.325, kLimits);
  Strip backwards = MakeStrip();
  backwards.along_W = -backwards.along_W;
  EXPECT_TRUE(AreAlike(path, MakeStripPath(backwards, {}, 0.325, kLimits), 0.001, 0.01));
}

TEST(CandidatePath, OtherPlaceViewOrLengthIsNotAlike) {
  const ScanPath path = MakeStripPath(MakeStrip(), {}, 0.325, kLimits);
  Strip other = MakeStrip();
  other.p_W.x() += 0.05;
  EXPECT_FALSE(AreAlike(path, MakeStripPath(other, {}, 0.325, kLimits), 0.02, 0.1));
  EXPECT_FALSE(AreAlike(path, MakeStripPath(MakeStrip(), {0.0, 0.02}, 0.325, kLimits), 0.02, 0.01));
  other = MakeStrip();
  other.extent_m *= 2.0;
  EXPECT_FALSE(AreAlike(path, MakeStripPath(other, {}, 0.325, kLimits), 0.02, 0.1));
}

TEST(CandidatePath, OfAlikeOnesTheFirstStays) {
  std::vector<Candidate> candidates(3);
  for (int i = 0; i < 3; ++i) candidates[i].rank = i;
  Strip strip = MakeStrip();
  candidates[0].path = MakeStripPath(strip, {}, 0.325, kLimits);
  candidates[2].path = MakeStripPath(strip, {}, 0.325, kLimits);
  strip.p_W.y() += 0.1;
  candidates[1].path = MakeStripPath(strip, {}, 0.325, kLimits);
  RemoveAlike(candidates, 0.02, 0.1);
  ASSERT_EQ(candidates.size(), 2u);
  EXPECT_EQ(candidates[0].rank, 0);
  EXPECT_EQ(candidates[1].rank, 1);
}

}  // namespace
}  // namespace nbs
