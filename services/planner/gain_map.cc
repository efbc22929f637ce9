#include "services/planner/gain_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

/// A run of cells along x, relative to a cell: the rows of a ball.
struct BallRow {
  int y, z, half;
};

std::vector<BallRow> MakeBall(double radius_cells) {
  std::vector<BallRow> rows;
  const int reach = static_cast<int>(radius_cells);
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      const double left = radius_cells * radius_cells - y * y - z * z;
      if (left >= 0.0) rows.push_back({y, z, static_cast<int>(std::sqrt(left))});
    }
  }
  return rows;
}

/// Marks the cells within the ball of any wall.
std::vector<uint8_t> FindNear(const GridShape& shape, const std::vector<uint16_t>& values, double radius_cells) {
  const std::vector<BallRow> ball = MakeBall(radius_cells);
  std::vector<uint8_t> near(values.size(), 0);
  int64_t index = 0;
  for (int z = 0; z < shape.size.z(); ++z) {
    for (int y = 0; y < shape.size.y(); ++y) {
      for (int x = 0; x < shape.size.x(); ++x, ++index) {
        if (values[index] != GainMap::kWall) continue;
        for (const BallRow& row : ball) {
          const int row_y = y + row.y, row_z = z + row.z;
          if (row_y < 0 || row_y >= shape.size.y() || row_z < 0 || row_z >= shape.size.z()) continue;
          const int first = std::max(0, x - row.half), last = std::min(shape.size.x() - 1, x + row.half);
          std::fill_n(near.begin() + shape.Index(first, row_y, row_z), last - first + 1, uint8_t{1});
        }
      }
    }
  }
  return near;
}

/// The value of every log-odds, before it is asked where the cell lies.
std::vector<uint16_t> MakeTable(GainRule rule) {
  const std::span<const uint16_t, 65536> entropy = EntropyTable();
  const int16_t free_log_odds = CalcLogOdds(kFreeProbability);
  std::vector<uint16_t> table(entropy.begin(), entropy.end());
  for (size_t i = 0; i < table.size(); ++i) {
    const auto log_odds = static_cast<int16_t>(static_cast<uint16_t>(i));
    if (IsOccupied(log_odds)) {
      table[i] = GainMap::kWall;
    } else if (rule == GainRule::kUnknownCount) {
      table[i] = log_odds == kUnobserved || log_odds > free_log_odds ? GainMap::kGoal : 0;
    }
  }
  return table;
}

}  // namespace

GainMap::GainMap(const VoxelGrid& grid, GainRule rule, double reach_m)
    : shape_(grid.shape()), values_(grid.cells().size() + 1) {
  const double radius_cells = reach_m / shape_.resolution_m;
  if (!(radius_cells >= 0.0 && radius_cells <= 60.0))
    throw std::invalid_argument("GainMap: a reach of " + std::to_string(reach_m) + " m");
  if (rule == GainRule::kUnknownCount) unit_ = EntropyTable()[static_cast<uint16_t>(kUnobserved)];
  const std::vector<uint16_t> table = MakeTable(rule);
  bool has_wall = false;
  for (size_t i = 0; i < grid.cells().size(); ++i) {
    values_[i] = table[static_cast<uint16_t>(grid.cells()[i])];
    has_wall |= values_[i] == kWall;
  }
  if (rule != GainRule::kNearSurface || !has_wall) return;
  const std::vector<uint8_t> near = FindNear(shape_, values_, radius_cells);
  for (size_t i = 0; i < values_.size(); ++i) {
    if (near[i] == 0) values_[i] = 0;
  }
}

}  // namespace nbs
