#include "common/mapping/octomap_exchange.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <string>

#include "common/runtime/error.h"

namespace nbs {
namespace {

class OctomapExchange : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("octomap_exchange_" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "voxels.ot";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Blocks of free and unobserved cells, noise in between: something to prune and something not to.
  static VoxelGrid MakeGrid() {
    VoxelGrid grid({Eigen::Vector3d(-0.11, 0.02, -0.005), 0.005, Eigen::Vector3i(30, 22, 41)});
    std::mt19937_64 engine(3);
    for (size_t i = 0; i < grid.cells().size(); ++i) {
      if (i % 30 < 17) grid.cells()[i] = -5074;
      if (engine() % 11 == 0) grid.cells()[i] = static_cast<int16_t>(static_cast<int>(engine() % 60000) - 30000);
    }
    return grid;
  }

  std::string Load() const {
    std::ifstream in(file_, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }
  void Store(const std::string& data) const { std::ofstream(file_, std::ios::binary) << data; }

  std::filesystem::path folder_, file_;
};

TEST_F(OctomapExchange, TreeHoldsEveryObservedCellAndNoOther) {
  const VoxelGrid grid = MakeGrid();
  WriteOctomap(grid, file_);
  const std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(file_.string()));
  const auto* tree = dynamic_cast<octomap::OcTree*>(any.get());
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->getResolution(), 0.005);
  const GridShape& shape = grid.shape();
  for (int z = -1; z <= shape.size.z(); ++z) {
    for (int y = -1; y <= shape.size.y(); ++y) {
      for (int x = -1; x <= shape.size.x(); ++x) {
        const Eigen::Vector3d p_W = shape.origin_W + Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5) * shape.resolution_m;
        const octomap::OcTreeNode* node = tree->search(p_W.x(), p_W.y(), p_W.z());
        const bool inside =
            x >= 0 && y >= 0 && z >= 0 && x < shape.size.x() && y < shape.size.y() && z < shape.size.z();
        const int16_t log_odds = inside ? grid.At(x, y, z) : kUnobserved;
        ASSERT_EQ(node == nullptr, log_odds == kUnobserved);
        if (node == nullptr) continue;
        ASSERT_EQ(node->getLogOdds(), log_odds / 1024.0F);
      }
    }
  }
}

TEST_F(OctomapExchange, OctomapAgreesOnWhatIsOccupied) {
  const VoxelGrid grid = MakeGrid();
  WriteOctomap(grid, file_);
  const std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(file_.string()));
  auto* tree = dynamic_cast<octomap::OcTree*>(any.get());
  ASSERT_NE(tree, nullptr);
  tree->setOccupancyThres(0.95);
  int64_t occupied = 0;
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    const int64_t edge = 1 << (tree->getTreeDepth() - leaf.getDepth());
    if (tree->isNodeOccupied(*leaf)) occupied += edge * edge * edge;
  }
  EXPECT_EQ(occupied, std::ranges::count_if(grid.cells(), IsOccupied));
}

TEST_F(OctomapExchange, ReadingReturnsWhatWasWritten) {
  const VoxelGrid grid = MakeGrid();
  WriteOctomap(grid, file_);
  EXPECT_EQ(ReadOctomap(file_, grid.shape()), grid);
}

TEST_F(OctomapExchange, AGridThatWasNeverObservedComesBack) {
  const VoxelGrid grid({Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i(3, 3, 3)});
  WriteOctomap(grid, file_);
  EXPECT_EQ(ReadOctomap(file_, grid.shape()), grid);
}

TEST_F(OctomapExchange, WritingLeavesNoTemporaryFile) {
  WriteOctomap(MakeGrid(), file_);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(OctomapExchange, WritingToAMissingFolderFails) {
  EXPECT_THROW(WriteOctomap(MakeGrid(), folder_ / "missing" / "voxels.ot"), std::runtime_error);
}

TEST_F(OctomapExchange, AFileThatIsCutShortIsRefused) {
  const VoxelGrid grid = MakeGrid();
  WriteOctomap(grid, file_);
  const std::string data = Load();
  for (const size_t length : {data.size() - 1, data.size() / 2, size_t{100}, size_t{0}}) {
    Store(data.substr(0, length));
    EXPECT_THROW((void)ReadOctomap(file_, grid.shape()), ConfigError) << length;
  }
}

TEST_F(OctomapExchange, AFileWithMoreThanItAnnouncesIsRefused) {
  const VoxelGrid grid = MakeGrid();
  WriteOctomap(grid, file_);
  Store(Load() + "x");
  EXPECT_THROW((void)ReadOctomap(file_, grid.shape()), ConfigError);
}

TEST_F(OctomapExchange, EqualNeighboursBecomeOneLeaf) {
  VoxelGrid grid({Eigen::Vector3d::Zero(), 0.005, Eigen::Vector3i::Constant(16)});
  std::ranges::fill(grid.cells(), int16_t{-5074});
  WriteOctomap(grid, file_);
  // The leaf of 16 cells and the 12 nodes above it.
  EXPECT_NE(Load().find("size 13\n"), std::string::npos);
  EXPECT_EQ(ReadOctomap(file_, grid.shape()), grid);
}

TEST_F(OctomapExchange, AMissingOrForeignFileIsRefused) {
  const GridShape shape = MakeGrid().shape();
  EXPECT_THROW((void)ReadOctomap(file_, shape), ConfigError);
  Store("ply\nformat ascii 1.0\n");
  EXPECT_THROW((void)ReadOctomap(file_, shape), ConfigError);
}

TEST_F(OctomapExchange, AnotherResolutionOrATooSmallShapeIsRefused) {
  const VoxelGrid grid = MakeGrid();
  WriteOctomap(grid, file_);
  GridShape shape = grid.shape();
  shape.size.z() -= 3;
  EXPECT_THROW((void)ReadOctomap(file_, shape), ConfigError);
  shape = {Eigen::Vector3d(-0.11, 0.02, -0.01), 0.01, Eigen::Vector3i(30, 22, 41)};
  EXPECT_THROW((void)ReadOctomap(file_, shape), ConfigError);
}

}  // namespace
}  // namespace nbs
