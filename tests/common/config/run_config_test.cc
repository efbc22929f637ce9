#include "common/config/run_config.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/common/config/config_testing.h"

namespace nbs {
namespace {

Pose MakeCrookedPose(double seed) {
  return MakePose({seed / 3.0, -seed / 7.0, 0.1 + 0.2}, Eigen::Quaterniond(0.3, seed, 0.7, -0.11).normalized());
}

/// A configuration in which no number has a short decimal form.
RunConfig MakeConfig(const std::filesystem::path& folder) {
  RunConfig config;
  config.folder = folder;
  config.name = "putto \"by\" the\\window: #1";
  config.run_id = -1234567890123456789;
  config.version = "0.1.0";
  config.object = "it's a file.ply";
  config.object_file = "/tmp/Ångström, [a]: b.ply";
  config.seed = 18446744073709551615u;
  config.completeness = 0.1 + 0.2;
  config.realtime = true;
  config.cell.profiler.fan_rad = 1.0 / 3.0;
  config.cell.X_FS = MakeCrookedPose(0.9);
  config.cell.sensor_body_S = {{{0.1, 1.0 / 3.0, -1e-17}, 2.0 / 3.0}, {{0, 0, 0}, 1e-9}};
  config.cell.table_z_m = -1.0 / 9.0;
  config.cell.first_view_W = {1.0 / 3.0, 1, 0};
  config.cell.table_half_m = {1.0 / 3.0, 0.7};
  config.cell.resolution_m = 0.003;
  ResolvePlacement({Eigen::Vector3d(-1.0 / 3.0, -0.2, 0), Eigen::Vector3d(0.1, 0.7 / 9.0, 0.5)}, config);
  return config;
}

std::string ReadText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The error of a run.yaml in which `from` was replaced.
std::string ErrorWith(const std::string& from, const std::string& to) {
  const auto folder = MakeTestFolder();
  WriteRunConfig(MakeConfig(folder));
  std::string text = ReadText(folder / "run.yaml");
  const size_t at = text.find(from);
  if (at == std::string::npos) return "`" + from + "` does not occur";
  text.replace(at, from.size(), to);
  std::ofstream(folder / "run.yaml") << text;
  return CatchConfigError([&] { ReadRunConfig(folder); });
}

TEST(RunConfig, ArmReadsBackBitForBitAndItsUrdfMovesWithTheFolder) {
  const auto folder = MakeTestFolder();
  RunConfig written = MakeConfig(folder);
  written.cell.robot = "arm";
  ArmConfig& arm = written.cell.arm.emplace();
  arm = {folder / "robot.urdf", "base",          "tool",           "numeric", "prm", "joint",
         MakeCrookedPose(0.4),  {1.0 / 3.0, -2}, {0.1, 7.0 / 9.0}, 1.0 / 7.0, 1e-9};
  WriteRunConfig(written);
  const auto moved = folder / "moved";
  std::filesystem::create_directory(moved);
  std::filesystem::copy_file(folder / "run.yaml", moved / "run.yaml");
  const ArmConfig read = ReadRunConfig(moved).cell.arm.value();
  EXPECT_EQ(read.urdf, moved / "robot.urdf");
  EXPECT_EQ(read.base_link, "base");
  EXPECT_EQ(read.flange_link, "tool");
  EXPECT_EQ(read.inverse_kinematics, "numeric");
  EXPECT_EQ(read.motion_search, "prm");
  EXPECT_EQ(read.registration, "joint");
  EXPECT_EQ(read.X_OB.matrix(), arm.X_OB.matrix());
  EXPECT_EQ(read.start_rad, arm.start_rad);
  EXPECT_EQ(read.max_rad_per_s2, arm.max_rad_per_s2);
  EXPECT_EQ(read.pose_bias_m, arm.pose_bias_m);
  EXPECT_EQ(read.pose_noise_m, arm.pose_noise_m);
}

TEST(RunConfig, ReadsBackWhatWasWrittenBitForBit) {
  const auto folder = MakeTestFolder();
  const RunConfig written = MakeConfig(folder);
  WriteRunConfig(written);
  const RunConfig read = ReadRunConfig(folder);
  EXPECT_EQ(read.folder, folder);
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.run_id, written.run_id);
  EXPECT_EQ(read.version, written.version);
  EXPECT_EQ(read.method, written.method);
  EXPECT_EQ(read.object, written.object);
  EXPECT_EQ(read.object_file, written.object_file);
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_EQ(read.completeness, written.completeness);
  EXPECT_EQ(read.max_scans, written.max_scans);
  EXPECT_EQ(read.realtime, written.realtime);
  EXPECT_EQ(read.grid, written.grid);
  EXPECT_EQ(read.first_path.X_WS_start.matrix(), written.first_path.X_WS_start.matrix());
  EXPECT_EQ(read.first_path.X_WS_end.matrix(), written.first_path.X_WS_end.matrix());
}

TEST(RunConfig, CellReadsBackBitForBit) {
  const auto folder = MakeTestFolder();
  const CellConfig written = MakeConfig(folder).cell;
  WriteRunConfig(MakeConfig(folder));
  const CellConfig read = ReadRunConfig(folder).cell;
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.robot, written.robot);
  EXPECT_EQ(read.profiler, written.profiler);
  EXPECT_EQ(read.X_FS.matrix(), written.X_FS.matrix());
  ASSERT_EQ(read.sensor_body_S.size(), 2u);
  EXPECT_EQ(read.sensor_body_S[0].center, written.sensor_body_S[0].center);
  EXPECT_EQ(read.sensor_body_S[1].radius_m, written.sensor_body_S[1].radius_m);
  EXPECT_EQ(read.body_margin_m, written.body_margin_m);
  EXPECT_EQ(read.move_speed_m_per_s, written.move_speed_m_per_s);
  EXPECT_EQ(read.turn_speed_rad_per_s, written.turn_speed_rad_per_s);
  EXPECT_EQ(read.resolution_m, written.resolution_m);
  EXPECT_EQ(read.unknown_margin_m, written.unknown_margin_m);
  EXPECT_EQ(read.table_z_m, written.table_z_m);
  EXPECT_EQ(read.first_view_W, written.first_view_W);
  EXPECT_EQ(read.first_along_W, written.first_along_W);
  EXPECT_EQ(read.first_standoff_m, written.first_standoff_m);
}

TEST(RunConfig, WritingWhatWasReadGivesTheSameFile) {
  const auto folder = MakeTestFolder();
  WriteRunConfig(MakeConfig(folder));
  const std::string first = ReadText(folder / "run.yaml");
  WriteRunConfig(ReadRunConfig(folder));
  EXPECT_EQ(ReadText(folder / "run.yaml"), first);
}

TEST(RunConfig, NoTemporaryFileIsLeft) {
  const auto folder = MakeTestFolder();
  WriteRunConfig(MakeConfig(folder));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(RunConfig, FolderThatIsNoRunIsRefused) {
  const auto folder = MakeTestFolder();
  EXPECT_EQ(CatchConfigError([&] { ReadRunConfig(folder); }), "run.yaml: cannot be read: No such file or directory");
}

TEST(RunConfig, MissingKeyIsRefused) {
  EXPECT_EQ(ErrorWith("max_scans: 30\n", ""), "run.yaml:2: key `max_scans` is missing");
}

TEST(RunConfig, MissingKeyOfTheCellIsRefused) {
  EXPECT_EQ(ErrorWith("  body_margin_m: 0.02\n", ""), "run.yaml:14: key `body_margin_m` is missing");
}

TEST(RunConfig, UnknownMethodIsRefused) {
  EXPECT_EQ(ErrorWith("\"BH/IG\"", "BHIG"), "run.yaml:5: unknown method `BHIG`: did you mean `BH/IG`?");
}

TEST(RunConfig, UnknownRateIsRefused) {
  EXPECT_EQ(ErrorWith("rate: realtime", "rate: fast"), "run.yaml:12: unknown rate `fast`: known are `max`, `realtime`");
}

TEST(RunConfig, SeedBeyondItsRangeIsRefused) {
  EXPECT_EQ(ErrorWith("18446744073709551615", "18446744073709551616"),
            "run.yaml:9: `seed` must be a whole number from 0 of 64 bits, not `18446744073709551616`");
}

TEST(RunConfig, NoScansAtAllIsRefused) {
  EXPECT_EQ(ErrorWith("max_scans: 30", "max_scans: 0"),
            "run.yaml:11: `max_scans` must be a whole number from 1 to 10000, not 0");
  EXPECT_EQ(ErrorWith("max_scans: 30", "max_scans: 10001"),
            "run.yaml:11: `max_scans` must be a whole number from 1 to 10000, not 10001");
}

TEST(RunConfig, CompletenessAboveOneIsRefused) {
  EXPECT_EQ(ErrorWith("completeness: 0.30000000000000004", "completeness: 98.75"),
            "run.yaml:10: `completeness` must be above 0 and at most 1, not 98.75");
}

TEST(RunConfig, GridOfAnotherResolutionIsRefused) {
  EXPECT_EQ(ErrorWith("resolution_m: 0.003\n  size", "resolution_m: 0.004\n  size"),
            "run.yaml:47: `resolution_m` of the grid (0.004) must be that of the cell (0.003)");
}

TEST(RunConfig, MoreVoxelsThanAnyGridHasAreRefused) {
  const Eigen::Vector3i size = MakeConfig(MakeTestFolder()).grid.size;
  const std::string written = "size: [" + std::to_string(size.x()) + ", " + std::to_string(size.y()) + ", ";
  EXPECT_EQ(ErrorWith(written + std::to_string(size.z()), "size: [1024, 1024, 129"),
            "run.yaml:48: `size` must not come to more than 134217728 voxels");
}

}  // namespace
}  // namespace nbs
