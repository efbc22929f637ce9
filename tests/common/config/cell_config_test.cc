#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/config/run_config.h"
#include "tests/common/config/config_testing.h"

namespace nbs {
namespace {

std::string ErrorOf(const std::string& yaml) {
  const auto file = WriteTestFile("cell.yaml", yaml);
  return CatchConfigError([&] { ReadCellConfig(file); });
}

TEST(CellConfig, ShippedFreeCellEqualsTheDefaultsButForItsBody) {
  const CellConfig cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/free.yaml");
  const CellConfig defaults;
  EXPECT_EQ(cell.name, "free");
  EXPECT_EQ(cell.profiler, defaults.profiler);
  EXPECT_TRUE(cell.X_FS.isApprox(Pose::Identity(), 0.0));
  EXPECT_FALSE(cell.sensor_body_S.empty());
  EXPECT_EQ(cell.resolution_m, defaults.resolution_m);
  EXPECT_FALSE(cell.table_z_m.has_value());
  EXPECT_EQ(cell.first_view_W, defaults.first_view_W);
}

TEST(CellConfig, AbsentKeysKeepTheirDefaults) {
  const CellConfig cell = ReadCellConfig(WriteTestFile("cell.yaml", "resolution_m: 0.01\n"));
  EXPECT_EQ(cell.resolution_m, 0.01);
  EXPECT_EQ(cell.profiler, Profiler{});
}

TEST(CellConfig, ACellWithoutABodyKeepsAHousingAndAnEmptyOneIsRefused) {
  EXPECT_EQ(ReadCellConfig(WriteTestFile("cell.yaml", "name: a\n")).sensor_body_S.size(), 8u);
  EXPECT_EQ(ErrorOf("name: a\nsensor_body_S: []\n"),
            "cell.yaml:2: `sensor_body_S` needs at least one sphere: without a body nothing keeps the profiler from "
            "touching the object");
}

TEST(CellConfig, UnknownKeyIsRefusedWithFileLineAndSuggestion) {
  EXPECT_EQ(ErrorOf("name: a\nresolutoin_m: 0.01\n"),
            "cell.yaml:2: unknown key `resolutoin_m`: did you mean `resolution_m`?");
}

TEST(CellConfig, UnknownKeyOfAnInnerMapIsRefused) {
  EXPECT_EQ(ErrorOf("profiler:\n  points: 10\n  rate_herz: 3\n"),
            "cell.yaml:3: unknown key `rate_herz`: did you mean `rate_hz`?");
}

TEST(CellConfig, DuplicateKeyIsRefused) {
  EXPECT_EQ(ErrorOf("resolution_m: 0.01\nname: a\nresolution_m: 0.02\n"),
            "cell.yaml:3: key `resolution_m` comes twice: the first is on line 1");
}

TEST(CellConfig, DuplicateKeyOfAnInnerMapIsRefused) {
  EXPECT_EQ(ErrorOf("profiler:\n  points: 10\n  points: 11\n"),
            "cell.yaml:3: key `points` comes twice: the first is on line 2");
}

TEST(CellConfig, AWordForANumberIsRefused) {
  EXPECT_EQ(ErrorOf("resolution_m: 5mm\n"), "cell.yaml:1: `resolution_m` must be a finite number, not `5mm`");
}

TEST(CellConfig, NotANumberIsRefused) {
  EXPECT_EQ(ErrorOf("resolution_m: nan\n"), "cell.yaml:1: `resolution_m` must be a finite number, not `nan`");
}

TEST(CellConfig, NumberOutOfRangeIsRefused) {
  EXPECT_EQ(ErrorOf("resolution_m: -0.01\n"),
            "cell.yaml:1: `resolution_m` must be at least 0.0005 and at most 0.5, not -0.01");
}

TEST(CellConfig, FractionOfABeamIsRefused) {
  EXPECT_EQ(ErrorOf("profiler: {points: 22.5}\n"), "cell.yaml:1: `points` must be a whole number, not `22.5`");
}

TEST(CellConfig, FarBeforeNearIsRefused) {
  EXPECT_EQ(ErrorOf("profiler:\n  max_depth_m: 0.1\n"),
            "cell.yaml:2: `max_depth_m` (0.1) must be above `min_depth_m` (0.15)");
}

TEST(CellConfig, UnknownRobotIsRefused) {
  EXPECT_EQ(ErrorOf("robot: fre\n"), "cell.yaml:1: unknown robot `fre`: did you mean `free`?");
}

TEST(CellConfig, ShippedArmCellNamesItsUrdfBesideItself) {
  const CellConfig cell = ReadCellConfig(std::filesystem::path(NBS_SOURCE_DIR) / "sim/cells/kr16.yaml");
  ASSERT_TRUE(cell.arm);
  EXPECT_TRUE(std::filesystem::exists(cell.arm->urdf));
  EXPECT_EQ(cell.arm->start_rad.size(), 6u);
  EXPECT_EQ(cell.profiler.camera_baseline_m, 0.12);
}

TEST(CellConfig, ArmWithoutItsSectionIsRefused) {
  EXPECT_EQ(ErrorOf("robot: arm\n"), "cell.yaml:1: the robot is an arm, but `arm` is missing");
  EXPECT_EQ(ErrorOf("arm: {urdf: a.urdf}\n"), "cell.yaml:1: `arm` needs `robot: arm`");
}

TEST(CellConfig, ArmWithoutJointValuesIsRefused) {
  EXPECT_EQ(ErrorOf("robot: arm\narm: {urdf: a.urdf, start_rad: [0, 1], max_rad_per_s2: [1]}\n"),
            "cell.yaml:2: `start_rad` and `max_rad_per_s2` must have a number for each joint");
  EXPECT_EQ(ErrorOf("robot: arm\narm: {start_rad: [0], max_rad_per_s2: [1]}\n"),
            "cell.yaml:2: an arm needs `urdf`, the name of its URDF file");
}

TEST(CellConfig, FirstPathAlongTheViewIsRefused) {
  EXPECT_THAT(ErrorOf("first_view_W: [0, 0, 1]\nfirst_along_W: [0, 0, 2]\n"),
              testing::StartsWith("cell.yaml:2: `first_along_W` must not be parallel to `first_"));
}

TEST(CellConfig, SphereWithoutRadiusIsRefused) {
  EXPECT_EQ(ErrorOf("sensor_body_S:\n  - {center_m: [0, 0, 0]}\n"), "cell.yaml:2: key `radius_m` is missing");
}

TEST(CellConfig, BrokenYamlIsRefusedWithItsLine) {
  EXPECT_THAT(ErrorOf("name: a\nprofiler: {points: 3\n"), testing::StartsWith("cell.yaml:3: no valid YAML:"));
}

TEST(CellConfig, ALoopOfAnchorsIsRefused) {
  EXPECT_EQ(ErrorOf("profiler: &a\n  points: *a\n"), "cell.yaml:1: nested more than 20 levels deep");
}

TEST(CellConfig, EmptyFileIsRefused) { EXPECT_EQ(ErrorOf(""), "cell.yaml:1: must be a map of keys and values"); }

TEST(CellConfig, MissingFileIsRefused) {
  EXPECT_EQ(CatchConfigError([] { ReadCellConfig("/nowhere/cell.yaml"); }),
            "cell.yaml: cannot be read: No such file or directory");
}

TEST(CellConfig, RollPitchYawTurnsAboutFixedAxes) {
  const double quarter = std::numbers::pi / 2;
  const auto file = WriteTestFile("cell.yaml", "X_FS: {position_m: [1, 2, 3], rpy_rad: [" + std::to_string(quarter) +
                                                   ", 0, " + std::to_string(quarter) + "]}\n");
  const Pose X_FS = ReadCellConfig(file).X_FS;
  // Roll takes y to z, which the yaw leaves alone.
  EXPECT_TRUE((X_FS.linear() * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-5));
  EXPECT_TRUE((X_FS.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-5));
  EXPECT_EQ(X_FS.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(CellConfig, MatrixThatIsNoRotationIsRefused) {
  EXPECT_THAT(ErrorOf("X_FS: {rotation: [1, 0, 0, 0, 1, 0, 0, 0, -1]}\n"),
              testing::StartsWith("cell.yaml:1: `rotation` is no rotation: i"));
}

}  // namespace
}  // namespace nbs
