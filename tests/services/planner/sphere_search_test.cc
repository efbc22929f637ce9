#include "services/planner/sphere_search.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nbs {
namespace {

const Eigen::AlignedBox3d kBox_W(Eigen::Vector3d(-0.1, -0.15, 0.0), Eigen::Vector3d(0.1, 0.15, 0.5));

TEST(SphereSearch, ThereAre121ViewpointsRankedFromTheTop) {
  const std::vector<Candidate> candidates = FindSphereCandidates(kBox_W, 3);
  ASSERT_EQ(candidates.size(), 121u);
  double last_z = 1e3;
  for (size_t i = 0; i < candidates.size(); ++i) {
    EXPECT_EQ(candidates[i].source, CandidateSource::kSphere);
    EXPECT_EQ(candidates[i].born_scan, 3);
    EXPECT_EQ(candidates[i].rank, static_cast<int>(i));
    const ScanPath& path = candidates[i].path;
    const double z = 0.5 * (path.X_WS_start.translation().z() + path.X_WS_end.translation().z());
    EXPECT_LT(z, last_z);
    last_z = z;
  }
}

TEST(SphereSearch, EachLooksAtTheMiddleFromTheRadiusThatHugsTheObject) {
  const double radius_m = 0.5 * kBox_W.diagonal().norm() + 0.15;
  for (const Candidate& candidate : FindSphereCandidates(kBox_W, 0)) {
    const Pose& start = candidate.path.X_WS_start;
    const Eigen::Vector3d middle = 0.5 * (start.translation() + candidate.path.X_WS_end.translation());
    EXPECT_NEAR((middle - kBox_W.center()).norm(), radius_m, 1e-9);
    EXPECT_NEAR(start.linear().col(2).dot((kBox_W.center() - middle).normalized()), 1.0, 1e-9);
  }
}

TEST(SphereSearch, EachSweepsOverTheWholeExtent) {
  for (const Candidate& candidate : FindSphereCandidates(kBox_W, 0)) {
    const Eigen::Vector3d along = candidate.path.X_WS_end.translation() - candidate.path.X_WS_start.translation();
    EXPECT_NEAR(along.norm(), kBox_W.sizes().dot(along.normalized().cwiseAbs()), 1e-9);
  }
}

TEST(SphereSearch, AnEmptyBoxIsRefused) {
  EXPECT_THROW(FindSphereCandidates({}, 0), std::invalid_argument);
  EXPECT_THROW(FindSphereCandidates(kBox_W, 0, {.viewpoints = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
