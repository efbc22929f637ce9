#include "common/mapping/octomap_exchange.h"

#include <octomap/OcTree.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "common/runtime/error.h"

namespace nbs {
namespace {

/// OctoMap's key of W's origin.
constexpr int kOriginKey = 32768;
/// A node of an .ot file: a float and one byte for its children.
constexpr std::uintmax_t kBytesPerNode = 5;
/// Clamps beyond every log-odds that an int16 in 1/1024 nat can hold.
constexpr double kWideClamp = 1e-15;
constexpr double kMaxNats = 31.0;

/// OctoMap's key of cell (0, 0, 0).
Eigen::Vector3i CalcFirstKey(const GridShape& shape) {
  const Eigen::Array3d cells = (shape.origin_W.array() / shape.resolution_m).round();
  return cells.cast<int>() + kOriginKey;
}

octomap::OcTreeKey MakeKey(const Eigen::Vector3i& key) {
  return {static_cast<octomap::key_type>(key.x()), static_cast<octomap::key_type>(key.y()),
          static_cast<octomap::key_type>(key.z())};
}

void FillTree(const VoxelGrid& grid, octomap::OcTree& tree) {
  const GridShape& shape = grid.shape();
  const Eigen::Vector3i first = CalcFirstKey(shape);
  if (first.minCoeff() < 0 || (first + shape.size).maxCoeff() > 2 * kOriginKey) {
    throw std::invalid_argument("WriteOctomap: the grid reaches outside of OctoMap's 2^16 cells per axis");
  }
  int64_t index = 0;
  for (int z = 0; z < shape.size.z(); ++z) {
    for (int y = 0; y < shape.size.y(); ++y) {
      for (int x = 0; x < shape.size.x(); ++x, ++index) {
        const int16_t log_odds = grid.cells()[index];
        if (log_odds == kUnobserved) continue;
        tree.setNodeValue(MakeKey(first + Eigen::Vector3i(x, y, z)), static_cast<float>(log_odds / kLogOddsPerNat),
                          true);
      }
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();
}

/// The text part of a file.
struct Header {
  std::string id;
  std::uintmax_t nodes = 0;
  double resolution_m = 0.0;
  std::uintmax_t length = 0;  ///< Bytes, up to the first node; 0: there is no end.
};

Header ReadHeader(std::istream& in) {
  Header header;
  std::string line;
  while (std::getline(in, line) && line.size() < 1024) {
    if (line == "data") {
      header.length = static_cast<std::uintmax_t>(in.tellg());
      break;
    }
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "id") words >> header.id;
    if (key == "size") words >> header.nodes;
    if (key == "res") words >> header.resolution_m;
  }
  return header;
}

std::unique_ptr<octomap::OcTree> ReadTree(const std::filesystem::path& file, double resolution_m) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw ConfigError(file.string() + ": cannot be read, give an OctoMap .ot file");
  const Header header = ReadHeader(in);
  if (header.id != "OcTree" || header.length == 0)
    throw ConfigError(file.string() + ": is no OctoMap file of an OcTree");
  if (!(std::abs(header.resolution_m - resolution_m) <= 1e-9)) {
    throw ConfigError(file.string() + ": has a resolution of " + std::to_string(header.resolution_m) +
                      " m, wanted is " + std::to_string(resolution_m) + " m");
  }
  // OctoMap itself reads a file that is cut short without complaint.
  const std::uintmax_t announced = header.length + header.nodes * kBytesPerNode,
                       length = std::filesystem::file_size(file);
  if (length != announced) {
    throw ConfigError(file.string() + ": is cut short or damaged, it announces " + std::to_string(announced) +
                      " bytes and has " + std::to_string(length));
  }
  auto tree = std::make_unique<octomap::OcTree>(resolution_m);
  if (header.nodes > 0) tree->readData(in);
  if (!in || tree->size() != header.nodes)
    throw ConfigError(file.string() + ": is damaged, its nodes do not form the announced tree");
  return tree;
}

/// Writes a leaf of the tree, a cube of `edge` cells from `corner` (cells of the grid), into the grid; false if it does
/// not fit.
bool InsertLeaf(const Eigen::Vector3i& corner, int edge, float nats, VoxelGrid& grid) {
  const GridShape& shape = grid.shape();
  if (corner.minCoeff() < 0 || ((corner.array() + edge) > shape.size.array()).any() || !(std::abs(nats) <= kMaxNats))
    return false;
  const auto log_odds = static_cast<int16_t>(std::lround(nats * kLogOddsPerNat));
  for (int z = corner.z(); z < corner.z() + edge; ++z) {
    for (int y = corner.y(); y < corner.y() + edge; ++y) {
      std::fill_n(grid.cells().begin() + shape.Index(corner.x(), y, z), edge, log_odds);
    }
  }
  return true;
}

}  // namespace

void WriteOctomap(const VoxelGrid& grid, const std::filesystem::path& file) {
  octomap::OcTree tree(grid.shape().resolution_m);
  tree.setOccupancyThres(0.95);
  tree.setClampingThresMin(kWideClamp);
  tree.setClampingThresMax(1.0 - kWideClamp);
  FillTree(grid, tree);
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    if (!out || !tree.write(out) || !out.flush()) throw std::runtime_error(temporary.string() + ": cannot be written");
  }
  std::filesystem::rename(temporary, file);
}

VoxelGrid ReadOctomap(const std::filesystem::path& file, const GridShape& shape) {
  const std::unique_ptr<octomap::OcTree> tree = ReadTree(file, shape.resolution_m);
  VoxelGrid grid(shape);
  const Eigen::Vector3i first = CalcFirstKey(shape);
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    const int edge = 1 << (tree->getTreeDepth() - leaf.getDepth());
    const octomap::OcTreeKey key = leaf.getIndexKey();
    if (!InsertLeaf(Eigen::Vector3i(key[0], key[1], key[2]) - first, edge, leaf->getLogOdds(), grid)) {
      throw ConfigError(file.string() + ": has cells outside of the voxel space or log-odds beyond 31 nats");
    }
  }
  return grid;
}

}  // namespace nbs
