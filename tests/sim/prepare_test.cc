#include "sim/prepare/prepare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "common/geometry/mesh_io.h"
#include "common/runtime/error.h"
#include "sim/load_object.h"
#include "tests/sim/shapes.h"

namespace nbs {
namespace {

using ::testing::HasSubstr;

class Prepare : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("prepare_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    WriteMeshPly(folder_ / "sphere.ply", MakeSphere(0.1f, 3));
    request_.object = (folder_ / "sphere.ply").string();
    request_.cells_dir = std::string(NBS_SOURCE_DIR) + "/sim/cells";
    request_.out = folder_ / "run";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Refusal() const {
    try {
      PrepareRun(request_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  RunRequest request_;
};

TEST_F(Prepare, AcceptsEveryMethodThatItLists) {
  std::istringstream list(ListMethods());
  std::string method, end;
  int count = 0;
  while (list >> method >> end) {
    request_.method = method;
    request_.out = folder_ / ("run" + std::to_string(count++));
    EXPECT_EQ(Refusal(), "accepted") << method;
    EXPECT_THAT(end, ::testing::AnyOf("completeness", "nothing_left", "settled")) << method;
  }
  EXPECT_EQ(count, 5);
  EXPECT_THAT(ListMethods(), HasSubstr("BH/IG completeness\n"));
}

TEST_F(Prepare, MakesAFolderThatServicesCanRead) {
  request_.seed = 7;
  request_.method = "S/IG";
  request_.rate = "realtime";
  request_.version = "v1";
  PrepareRun(request_);
  EXPECT_TRUE(std::filesystem::is_directory(request_.out / "streams"));
  EXPECT_TRUE(std::filesystem::is_directory(request_.out / "logs"));
  const RunConfig config = ReadRunConfig(request_.out);
  EXPECT_EQ(config.seed, 7u);
  EXPECT_EQ(config.method, "S/IG");
  EXPECT_EQ(config.name, "run");
  EXPECT_EQ(config.version, "v1");
  EXPECT_TRUE(config.realtime);
  EXPECT_EQ(config.object_file, folder_ / "sphere.ply");
  EXPECT_EQ(config.cell.name, "free");
}

TEST_F(Prepare, VoxelSpaceHoldsTheObjectWithItsMargin) {
  const RunConfig config = PrepareRun(request_);
  const double margin = config.cell.unknown_margin_m;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(config.grid.origin_W[axis], -0.1 - margin + 1e-6);
    EXPECT_GE(config.grid.origin_W[axis] + config.grid.size[axis] * config.grid.resolution_m, 0.1 + margin - 1e-6);
  }
}

TEST_F(Prepare, TwoRunsDifferInTheirIdAlone) {
  RunConfig a = PrepareRun(request_);
  request_.out = folder_ / "other";
  const RunConfig b = PrepareRun(request_);
  EXPECT_NE(a.run_id, b.run_id);
  EXPECT_EQ(a.grid, b.grid);
  EXPECT_EQ(a.first_path.X_WS_start.matrix(), b.first_path.X_WS_start.matrix());
}

TEST_F(Prepare, EmptyFolderIsTaken) {
  std::filesystem::create_directories(request_.out);
  EXPECT_EQ(Refusal(), "accepted");
}

TEST_F(Prepare, EarlierRunIsNeverTouched) {
  PrepareRun(request_);
  const auto written = std::filesystem::last_write_time(request_.out / "run.yaml");
  EXPECT_THAT(Refusal(), HasSubstr("holds an earlier run"));
  EXPECT_EQ(std::filesystem::last_write_time(request_.out / "run.yaml"), written);
}

TEST_F(Prepare, FolderWithSomethingElseIsRefused) {
  std::filesystem::create_directories(request_.out);
  std::ofstream(request_.out / "letter.txt") << "dear";
  EXPECT_THAT(Refusal(), HasSubstr("is not empty"));
}

TEST_F(Prepare, MissingObjectLeavesNoFolderBehind) {
  request_.object = "nowhere.ply";
  EXPECT_THAT(Refusal(), HasSubstr("nowhere.ply does not exist"));
  EXPECT_FALSE(std::filesystem::exists(request_.out));
}

TEST_F(Prepare, ObjectInMillimetresIsRefusedWithTheRemedy) {
  WriteMeshPly(folder_ / "sphere.ply", MakeSphere(100.0f, 3));
  EXPECT_THAT(Refusal(), HasSubstr("scale it by 0.001"));
}

TEST_F(Prepare, TinyObjectIsRefused) {
  WriteMeshPly(folder_ / "sphere.ply", MakeSphere(0.0005f, 3));
  EXPECT_THAT(Refusal(), HasSubstr("too small"));
}

TEST_F(Prepare, RealObjectIsABoxWithoutATruth) {
  request_.box_m = {0.2, 0.3, 0.4};
  const RunConfig config = PrepareRun(request_);
  EXPECT_EQ(config.object, "");
  EXPECT_EQ(config.object_file, "");
  EXPECT_FALSE(HasTruth(ReadRunConfig(request_.out)));
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(config.cell.unknown_margin_m);
  const Eigen::Vector3d low = Eigen::Vector3d(-0.1, -0.15, 0.0) - margin,
                        high = Eigen::Vector3d(0.1, 0.15, 0.4) + margin;
  const Eigen::Vector3d end_W = config.grid.origin_W + config.grid.resolution_m * config.grid.size.cast<double>();
  EXPECT_TRUE(((config.grid.origin_W - low).array().abs() < config.grid.resolution_m).all());
  EXPECT_TRUE(((end_W - high).array().abs() < config.grid.resolution_m).all());
}

TEST_F(Prepare, BoxWithoutRoomOrInMillimetresIsRefused) {
  request_.box_m = {0.2, -0.3, 0.4};
  EXPECT_EQ(Refusal(), "The sizes of the box must all be above 0, not 0.2, -0.3 and 0.4 m.");
  request_.box_m = {200, 300, 400};
  EXPECT_THAT(Refusal(), HasSubstr("looks like millimetres"));
  EXPECT_FALSE(std::filesystem::exists(request_.out));
}

TEST_F(Prepare, MoreVoxelsThanMemoryAreRefused) {
  request_.memory_bytes = 12'000'000;  // The box takes 60^3 voxels, 13 MB.
  EXPECT_THAT(Refusal(), HasSubstr("216000 voxels of 0.005 m around the object would take 0.0 GB"));
  EXPECT_FALSE(std::filesystem::exists(request_.out));
  request_.memory_bytes = 13'500'000;
  EXPECT_EQ(Refusal(), "accepted");
}

TEST_F(Prepare, UnknownCellNamesTheKnownOnes) {
  request_.cell = "fre";
  EXPECT_THAT(Refusal(), HasSubstr("no cell `fre`"));
  EXPECT_THAT(Refusal(), HasSubstr("free"));
}

TEST_F(Prepare, WrongValuesAreRefusedByName) {
  request_.method = "BH";
  EXPECT_THAT(Refusal(), HasSubstr("unknown method `BH`"));
  request_.method = "B";
  request_.gain = "sum";
  EXPECT_THAT(Refusal(), HasSubstr("B does not rate by gain"));
  request_.method = "BH/IG";
  request_.gain = "sun";
  EXPECT_THAT(Refusal(), HasSubstr("unknown gain rule `sun`: did you mean `sum`?"));
  request_.gain = "";
  request_.rate = "fast";
  EXPECT_THAT(Refusal(), HasSubstr("Unknown rate `fast`"));
  request_.rate = "max";
  request_.completeness = 98.75;
  EXPECT_THAT(Refusal(), HasSubstr("completeness"));
  request_.completeness = 0.9;
  request_.max_scans = 0;
  EXPECT_THAT(Refusal(), HasSubstr("number of scans"));
  request_.max_scans = 10001;
  EXPECT_THAT(Refusal(), HasSubstr("number of scans must lie between 1 and 10000, not 10001"));
}

}  // namespace
}  // namespace nbs
