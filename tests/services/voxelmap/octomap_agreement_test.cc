// The whole map update against OctoMap's own, under the rules of insertPointCloud.

#include <gtest/gtest.h>

#include <cmath>

#include "common/runtime/counter_random.h"
#include "services/voxelmap/map_update.h"
#include "tests/services/voxelmap/tree_of_our_model.h"

namespace nbs {
namespace {

constexpr int kOriginKey = 32768;

/// Stripes of a bumpy ball of 100 mm around W's origin, seen from everywhere.
Stripe MakeStripe(const Profiler& profiler, uint64_t i) {
  const Eigen::Vector3d view_W =
      Eigen::Vector3d(CalcGaussian({i, 0}), CalcGaussian({i, 1}), CalcGaussian({i, 2})).normalized();
  const Eigen::Vector3d scan_W = view_W.unitOrthogonal();
  Stripe stripe;
  stripe.index = static_cast<int32_t>(i);
  stripe.X_WS = MakeLookPose(-0.3 * view_W + (0.05 * CalcGaussian({i, 3})) * scan_W, view_W, scan_W);
  const Eigen::Vector3d p_WS = stripe.X_WS.translation();
  for (const Eigen::Vector3d& beam_S : CalcBeamDirections_S(profiler)) {
    const Eigen::Vector3d beam_W = stripe.X_WS.linear() * beam_S;
    const double along = -p_WS.dot(beam_W);
    const double square = 0.05 * 0.05 - (p_WS.squaredNorm() - along * along);
    const double bump = 0.004 * std::sin(70.0 * beam_W.x()) * std::cos(90.0 * beam_W.z());
    stripe.ranges_m.push_back(square > 0.0 ? static_cast<float>(along - std::sqrt(square) + bump) : 0.0F);
  }
  return stripe;
}

void Insert(const Profiler& profiler, const Stripe& stripe, octomap::OcTree& tree) {
  octomap::Pointcloud cloud;
  for (int i = 0; i < profiler.points; ++i) {
    if (stripe.ranges_m[i] == 0.0F) continue;
    const Eigen::Vector3f p_W = (stripe.X_WS * (stripe.ranges_m[i] * CalcBeamDirection_S(profiler, i))).cast<float>();
    cloud.push_back(p_W.x(), p_W.y(), p_W.z());
  }
  const Eigen::Vector3f p_WS = stripe.X_WS.translation().cast<float>();
  tree.insertPointCloud(cloud, {p_WS.x(), p_WS.y(), p_WS.z()}, -1.0, true);
}

TEST(OctomapAgreement, TheMapIsOctomapsCellForCellButForNearTies) {
  const Profiler profiler;
  InverseSensorModelSettings settings;
  settings.free_margin_sigma = 0.0;
  settings.spare_occupied = false;
  const GridShape shape{Eigen::Vector3d::Constant(-0.15), 0.005, Eigen::Vector3i::Constant(60)};
  MapUpdate map(shape, profiler, settings);
  TreeOfOurModel tree(shape.resolution_m);
  for (uint64_t i = 0; i < 400; ++i) {
    const Stripe stripe = MakeStripe(profiler, i);
    map.Insert(stripe);
    Insert(profiler, stripe, tree);
  }
  int64_t observed = 0, different = 0;
  for (int z = 0; z < 60; ++z) {
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) {
        const octomap::OcTreeNode* node =
            tree.search(octomap::OcTreeKey(kOriginKey - 30 + x, kOriginKey - 30 + y, kOriginKey - 30 + z));
        const int16_t ours = map.grid().At(x, y, z);
        observed += ours != kUnobserved ? 1 : 0;
        const bool same = node == nullptr ? ours == kUnobserved : node->getLogOdds() == ours / 1024.0F;
        different += same ? 0 : 1;
      }
    }
  }
  EXPECT_GT(observed, 40000);
  // OctoMap keeps points and directions in single precision.
  EXPECT_LE(different, observed / 5000);
}

}  // namespace
}  // namespace nbs
