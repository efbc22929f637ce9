#include "services/voxelmap/inverse_sensor_model.h"

#include <gtest/gtest.h>

#include "common/runtime/error.h"

namespace nbs {
namespace {

Stripe MakeStripe(const Profiler& profiler, float range_m) {
  Stripe stripe;
  stripe.X_WS = MakeLookPose({0.0, -0.3, 0.0}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
  stripe.ranges_m.assign(profiler.points, range_m);
  return stripe;
}

StripeEvidence Calc(const Profiler& profiler, const Stripe& stripe) {
  return CalcStripeEvidence(profiler, CalcBeamDirections_S(profiler), 3.0, stripe);
}

TEST(InverseSensorModel, NoReturnProvesNothing) {
  const Profiler profiler;
  const StripeEvidence evidence = Calc(profiler, MakeStripe(profiler, 0.0F));
  EXPECT_TRUE(evidence.hits_W.empty());
  EXPECT_TRUE(evidence.fans[0].ends_W.empty());
}

TEST(InverseSensorModel, AReturnOutsideTheDepthOfFieldProvesNothing) {
  Profiler profiler;
  profiler.fan_rad = 0.1;
  EXPECT_TRUE(Calc(profiler, MakeStripe(profiler, 0.14F)).hits_W.empty());
  EXPECT_TRUE(Calc(profiler, MakeStripe(profiler, 0.51F)).hits_W.empty());
  EXPECT_EQ(Calc(profiler, MakeStripe(profiler, 0.3F)).hits_W.size(), 224U);
}

TEST(InverseSensorModel, AReturnClearsTheLineFromTheEmitterToKSigmaBeforeIt) {
  const Profiler profiler;
  const Stripe stripe = MakeStripe(profiler, 0.4F);
  const StripeEvidence evidence = Calc(profiler, stripe);
  ASSERT_EQ(evidence.fans.size(), 1U);
  ASSERT_EQ(evidence.fans[0].ends_W.size(), 224U);
  EXPECT_LT((evidence.fans[0].p_WA - stripe.X_WS.translation()).norm(), 1e-12);
  for (int i = 0; i < 224; ++i) {
    const Eigen::Vector3d beam_W = stripe.X_WS.linear() * CalcBeamDirection_S(profiler, i);
    const double sigma = CalcRangeSigma(profiler, 0.4F * CalcBeamDirection_S(profiler, i).z());
    EXPECT_LT((evidence.hits_W[i] - (stripe.X_WS.translation() + 0.4F * beam_W)).norm(), 1e-12);
    EXPECT_LT((evidence.fans[0].ends_W[i] - (evidence.hits_W[i] - 3.0 * sigma * beam_W)).norm(), 1e-12);
  }
}

TEST(InverseSensorModel, TheCameraClearsItsOwnLineIfThereIsABaseline) {
  Profiler profiler;
  profiler.camera_baseline_m = 0.12;
  const Stripe stripe = MakeStripe(profiler, 0.4F);
  const StripeEvidence evidence = Calc(profiler, stripe);
  ASSERT_EQ(evidence.fans.size(), 2U);
  ASSERT_EQ(evidence.fans[1].ends_W.size(), 224U);
  const Eigen::Vector3d p_WC = stripe.X_WS * Eigen::Vector3d(0.0, 0.12, 0.0);
  EXPECT_LT((evidence.fans[1].p_WA - p_WC).norm(), 1e-12);
  const Eigen::Vector3d to_end = evidence.fans[1].ends_W[0] - p_WC, to_hit = evidence.hits_W[0] - p_WC;
  EXPECT_LT(to_end.cross(to_hit).norm(), 1e-12);
  EXPECT_LT(to_end.norm(), to_hit.norm());
}

TEST(InverseSensorModel, DefaultWeightsMakeOneHitOccupiedWhateverCameBefore) {
  const LogOddsSteps steps = MakeLogOddsSteps({});
  EXPECT_TRUE(IsOccupied(static_cast<int16_t>(steps.lowest + steps.hit)));
  EXPECT_TRUE(IsOccupied(steps.highest));
}

TEST(InverseSensorModel, BadWeightsAreRefused) {
  const auto refused = [](auto change) {
    InverseSensorModelSettings settings;
    change(settings);
    EXPECT_THROW((void)MakeLogOddsSteps(settings), ConfigError);
  };
  refused([](auto& s) { s.hit_nat = 0.0; });
  refused([](auto& s) { s.hit_nat = 4.0; });
  refused([](auto& s) { s.hit_nat = 40.0; });
  refused([](auto& s) { s.miss_nat = -1.0; });
  refused([](auto& s) { s.min_probability = 0.0; });
  refused([](auto& s) { s.min_probability = 0.6; });
  refused([](auto& s) { s.max_probability = 0.94; });
  refused([](auto& s) { s.max_probability = 1.0; });
}

}  // namespace
}  // namespace nbs
