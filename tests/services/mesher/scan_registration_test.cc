#include "services/mesher/scan_registration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/geometry/directions.h"
#include "tests/services/mesher/synthetic_scan.h"

namespace nbs {
namespace {

constexpr double kRadius_m = 0.08;

/// What a scan that looks along -side sees of a sphere, moved by what `offset` says of a point's `along`.
template <typename Offset>
void AddSphereScan(int32_t scan, const Eigen::Vector3d& side, const Offset& offset, std::vector<ScanPatch>& patches) {
  const Eigen::AngleAxisd turn(0.1 * scan, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());  // No two scans alike.
  for (const Eigen::Vector3d& d : MakeSphereDirections(6000)) {
    const Eigen::Vector3d normal_W = turn * d;
    if (normal_W.dot(side) < 0.1) continue;
    const double along = normal_W.z();
    patches.push_back({kRadius_m * normal_W + offset(along), normal_W, scan, along});
  }
}

std::vector<Eigen::Vector3d> MakeSides() {
  return {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY()};
}

/// Millimetres; they add up to zero.
std::vector<Eigen::Vector3d> MakeOffsets() {
  return {{1e-3, 0.5e-3, -0.4e-3}, {-0.7e-3, 0.9e-3, 0.2e-3}, {0.4e-3, -1.0e-3, 0.8e-3}, {-0.7e-3, -0.4e-3, -0.6e-3}};
}

/// A flat piece of 60 mm in z = 0, facing up.
void AddPlaneScan(int32_t scan, const Eigen::Vector3d& offset_W, std::vector<ScanPatch>& patches) {
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const Eigen::Vector3d p_W(0.003 * i + 0.0007 * scan, 0.003 * j + 0.0011 * scan, 0.0);
      patches.push_back({p_W + offset_W, Eigen::Vector3d::UnitZ(), scan, 0.1 * i - 1.0});
    }
  }
}

Eigen::Vector3d SumMiddles(const std::vector<ScanCorrection>& corrections) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ScanCorrection& correction : corrections) sum += correction.middle_W;
  return sum;
}

TEST(ScanRegistration, RecoversTheOffsetOfEachScan) {
  std::vector<ScanPatch> patches;
  for (int32_t scan = 0; scan < 4; ++scan)
    AddSphereScan(
        scan, MakeSides()[scan], [&](double) -> Eigen::Vector3d { return MakeOffsets()[scan]; }, patches);
  const std::vector<ScanCorrection> corrections = RegisterScans(patches, 4);
  for (size_t scan = 0; scan < 4; ++scan) {
    for (const double along : {-1.0, 0.0, 1.0})
      EXPECT_LT((corrections[scan].CalcOffset(along) + MakeOffsets()[scan]).norm(), 0.05e-3) << scan << " at " << along;
  }
}

TEST(ScanRegistration, RecoversAnOffsetThatChangesAlongTheScan) {
  std::vector<ScanPatch> patches;
  const Eigen::Vector3d slope_W(0.3e-3, -0.2e-3, 0.25e-3);
  for (int32_t scan = 0; scan < 4; ++scan) {
    const double sign = scan % 2 == 0 ? 1.0 : -1.0;
    AddSphereScan(
        scan, MakeSides()[scan],
        [&](double along) -> Eigen::Vector3d { return MakeOffsets()[scan] + sign * along * slope_W; }, patches);
  }
  const std::vector<ScanCorrection> corrections = RegisterScans(patches, 4);
  for (size_t scan = 0; scan < 4; ++scan) {
    const double sign = scan % 2 == 0 ? 1.0 : -1.0;
    EXPECT_LT((corrections[scan].slope_W + sign * slope_W).norm(), 0.06e-3) << scan;
    EXPECT_LT((corrections[scan].middle_W + MakeOffsets()[scan]).norm(), 0.05e-3) << scan;
  }
}

TEST(ScanRegistration, WhatAllScansHaveInCommonStays) {
  std::vector<ScanPatch> patches;
  const Eigen::Vector3d common_W(2e-3, -1e-3, 0.5e-3);
  for (int32_t scan = 0; scan < 4; ++scan)
    AddSphereScan(
        scan, MakeSides()[scan], [&](double) -> Eigen::Vector3d { return MakeOffsets()[scan] + common_W; }, patches);
  const std::vector<ScanCorrection> corrections = RegisterScans(patches, 4);
  EXPECT_LT(SumMiddles(corrections).norm(), 1e-9);
  for (size_t scan = 0; scan < 4; ++scan)
    EXPECT_LT((corrections[scan].middle_W + MakeOffsets()[scan]).norm(), 0.05e-3) << scan;
}

TEST(ScanRegistration, ScansThatDoNotOverlapStayWhereTheyWere) {
  std::vector<ScanPatch> patches;
  AddPlaneScan(0, Eigen::Vector3d::Zero(), patches);
  AddPlaneScan(2, {0.0, 0.0, 0.02}, patches);  // Scan 1 saw nothing.
  for (const ScanCorrection& correction : RegisterScans(patches, 3)) {
    EXPECT_EQ(correction.middle_W, Eigen::Vector3d::Zero());
    EXPECT_EQ(correction.slope_W, Eigen::Vector3d::Zero());
  }
}

TEST(ScanRegistration, APlaneTellsItsNormalOnly) {
  std::vector<ScanPatch> patches;
  AddPlaneScan(0, Eigen::Vector3d::Zero(), patches);
  AddPlaneScan(1, Eigen::Vector3d::Constant(1e-3), patches);
  const std::vector<ScanCorrection> corrections = RegisterScans(patches, 2);
  EXPECT_LT((corrections[0].middle_W - Eigen::Vector3d(0.0, 0.0, 0.5e-3)).norm(), 0.01e-3);
  EXPECT_LT((corrections[1].middle_W - Eigen::Vector3d(0.0, 0.0, -0.5e-3)).norm(), 0.01e-3);
}

TEST(ScanRegistration, PointsBesideTheSurfaceDoNotPull) {
  std::vector<ScanPatch> patches;
  AddPlaneScan(0, Eigen::Vector3d::Zero(), patches);
  AddPlaneScan(1, {0.0, 0.0, 0.4e-3}, patches);
  for (size_t i = 0; i < patches.size(); i += 5) patches[i].p_W.z() += 3e-3;
  const std::vector<ScanCorrection> corrections = RegisterScans(patches, 2);
  EXPECT_NEAR(corrections[0].middle_W.z() - corrections[1].middle_W.z(), 0.4e-3, 0.02e-3);
}

TEST(ScanRegistration, ThePatchesBackIsAnotherSurface) {
  std::vector<ScanPatch> patches;
  AddPlaneScan(0, Eigen::Vector3d::Zero(), patches);
  AddPlaneScan(1, {0.0, 0.0, -1e-3}, patches);  // A plate of 1 mm, seen from above and from below.
  for (ScanPatch& patch : patches) {
    if (patch.scan == 1) patch.normal_W = Eigen::Vector3d(0.1, 0.1, -1.0).normalized();
  }
  for (const ScanCorrection& correction : RegisterScans(patches, 2)) EXPECT_EQ(correction.middle_W.norm(), 0.0);
}

TEST(ScanRegistration, RefusesAScanBeyondTheCount) {
  std::vector<ScanPatch> patches;
  AddPlaneScan(2, Eigen::Vector3d::Zero(), patches);
  EXPECT_THROW(RegisterScans(patches, 2), std::invalid_argument);
}

/// Scans of a sphere and a box beside each other, from all around.
class RegisteredStripes : public testing::Test {
 protected:
  RegisteredStripes() {
    std::vector<Sweep> sweeps = MakeSweepsAround(0.06, 0.30, 4, 0.7);
    for (Sweep& sweep : sweeps) sweep.offset_W = CalcTrueOffset(sweep.scan);
    const Solid solid = MakeUnion(MakeSolidSphere(0.05), MakeSolidBox({0.04, 0.01, 0.0}, {0.02, 0.03, 0.04}));
    for (const Sweep& sweep : sweeps) {
      for (const Stripe& stripe : ScanSolid(solid, profiler_, sweep)) stripes_.push_back(stripe);
    }
    scans_ = static_cast<int>(sweeps.size());
  }

  static Eigen::Vector3d CalcTrueOffset(int32_t scan) {
    return 1e-3 * Eigen::Vector3d(std::sin(1.7 * scan), std::cos(2.3 * scan), std::sin(0.9 * scan + 1.0));
  }

  Profiler profiler_;
  std::vector<Stripe> stripes_;
  int scans_ = 0;
};

TEST_F(RegisteredStripes, StandWhereTheyTrulyStoodButForTheMean) {
  Eigen::Vector3d mean_W = Eigen::Vector3d::Zero();
  for (int32_t scan = 0; scan < scans_; ++scan) mean_W += CalcTrueOffset(scan) / scans_;
  const std::vector<Stripe> registered = MakeRegisteredStripes(profiler_, stripes_);
  ASSERT_EQ(registered.size(), stripes_.size());
  for (size_t i = 0; i < stripes_.size(); ++i) {
    EXPECT_EQ(registered[i].ranges_m, stripes_[i].ranges_m);
    EXPECT_EQ(registered[i].X_WS.linear(), stripes_[i].X_WS.linear());
    if (stripes_[i].end_of_scan) continue;
    const Eigen::Vector3d moved_W = registered[i].X_WS.translation() - stripes_[i].X_WS.translation();
    EXPECT_LT((moved_W + CalcTrueOffset(stripes_[i].scan) - mean_W).norm(), 0.15e-3) << stripes_[i].scan;
  }
}

TEST_F(RegisteredStripes, DamagedRangesMakeNoPatches) {
  std::vector<Stripe> damaged = stripes_, cleared = stripes_;
  for (size_t i = 0; i < stripes_.size(); ++i) {
    if (stripes_[i].end_of_scan) continue;
    damaged[i].ranges_m[3] = std::numeric_limits<float>::quiet_NaN();
    damaged[i].ranges_m[5] = std::numeric_limits<float>::infinity();
    std::fill_n(damaged[i].ranges_m.begin() + 10, 60, 1.1f);   // Walls beyond twice the depth of field,
    std::fill_n(damaged[i].ranges_m.begin() + 80, 30, -0.2f);  // and behind the sensor.
    for (size_t beam = 0; beam < damaged[i].ranges_m.size(); ++beam) {
      if (damaged[i].ranges_m[beam] != stripes_[i].ranges_m[beam]) cleared[i].ranges_m[beam] = 0.0f;
    }
  }
  const auto a = MakeScanPatches(profiler_, damaged), b = MakeScanPatches(profiler_, cleared);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].p_W, b[i].p_W);
}

TEST_F(RegisteredStripes, StripesThatTheMesherRefusesMakeNoPatches) {
  std::vector<Stripe> damaged = stripes_, without = stripes_;
  for (size_t i = 0; i + 3 < stripes_.size(); i += 40) {
    damaged[i].X_WS.translation().x() = std::numeric_limits<double>::quiet_NaN();
    damaged[i + 1].X_WS.translation().x() = 1e9;
    damaged[i + 2].ranges_m.resize(7);
    for (size_t k = i; k < i + 3; ++k) std::ranges::fill(without[k].ranges_m, 0.0f);
  }
  const auto a = MakeScanPatches(profiler_, damaged), b = MakeScanPatches(profiler_, without);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].p_W, b[i].p_W);
}

TEST_F(RegisteredStripes, PatchesLieOnTheSurfaceAndFaceTheSensor) {
  for (Stripe& stripe : stripes_)
    if (!stripe.end_of_scan) stripe.X_WS.translation() -= CalcTrueOffset(stripe.scan);
  const std::vector<ScanPatch> patches = MakeScanPatches(profiler_, stripes_);
  ASSERT_GT(patches.size(), 3000u);
  int of_sphere = 0;
  double sum_m = 0.0;
  for (const ScanPatch& patch : patches) {
    if (patch.p_W.x() > 0.01) continue;
    ++of_sphere;
    sum_m += patch.p_W.norm() - 0.05;
    EXPECT_GT(patch.normal_W.dot(patch.p_W.normalized()), 0.8);
    EXPECT_LE(std::abs(patch.along), 1.0);
  }
  EXPECT_GT(of_sphere, 1000);
  EXPECT_LT(std::abs(sum_m / of_sphere), 0.05e-3);
}

TEST(ScanPatches, SayWhenTheirScanSawThem) {
  Stripe stripe;
  stripe.index = 30;
  EXPECT_EQ(CalcAlong(stripe, 30), 1.0);
  EXPECT_EQ(CalcAlong(stripe, 60), 0.0);
  stripe.index = 0;
  EXPECT_EQ(CalcAlong(stripe, 30), -1.0);
  EXPECT_EQ(CalcAlong(stripe, 0), 0.0);
  stripe.scan = -1;
  EXPECT_THROW(FindLastIndices({&stripe, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
