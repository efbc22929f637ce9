#include "services/planner/motion_planning/obstacle_pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/kinematics/shape_distance.h"

namespace nbs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Bodies, lengths in cells. Each tells the square of its distance from a point, and its distance from a cube.
struct LineBody {
  Vector3d p_A;
  Vector3d p_B;
  double reach;
  Vector3d along = p_B - p_A;
  double per_square = 1.0 / std::max(along.squaredNorm(), 1e-12);

  double CalcSquare(const Vector3d& p) const {
    const double share = std::clamp((p - p_A).dot(along) * per_square, 0.0, 1.0);
    return (p - p_A - share * along).squaredNorm();
  }
  double CalcCubeDistance(const Vector3d& middle, double half) const {
    return CalcSegmentBoxDistance(p_A - middle, p_B - middle, Vector3d::Constant(half));
  }
};

struct BlockBody {
  Block block;
  double reach;
  Pose X_CL = block.X_LC.inverse();

  double CalcSquare(const Vector3d& p) const {
    return ((X_CL * p).cwiseAbs() - block.half).cwiseMax(0.0).squaredNorm();
  }
  double CalcCubeDistance(const Vector3d& middle, double half) const {
    Block moved = block;
    moved.X_LC.translation() -= middle;
    return CalcBlockBoxDistance(moved, Vector3d::Constant(half));
  }
};

}  // namespace

ObstaclePyramid::ObstaclePyramid(const VoxelGrid& grid, Obstacles obstacles, double free_max_probability)
    : grid_(grid), obstacles_(obstacles), free_(CalcLogOdds(free_max_probability)) {
  do {
    const size_t below = levels_.size();
    const Vector3i size = SizeOf(below);
    Level level{(size.array() + 1) / 2, {}};
    level.any.resize(static_cast<size_t>(level.size.x()) * level.size.y() * level.size.z());
    for (int z = 0; z < size.z(); ++z) {
      for (int y = 0; y < size.y(); ++y) {
        uint8_t* row = level.any.data() + level.Index({0, y / 2, z / 2});
        for (int x = 0; x < size.x(); ++x) row[x / 2] |= HasAny(below, {x, y, z}) ? 1 : 0;
      }
    }
    levels_.push_back(std::move(level));
  } while (levels_.back().size.maxCoeff() > 1);
}

template <typename Body>
bool ObstaclePyramid::IsTouched(const Body& body, size_t level, const Vector3i& at) const {
  constexpr double kToCorner = 1.7320508075688772;  // of a cube's middle, in half edges
  if (!HasAny(level, at)) return false;
  const double half = std::ldexp(0.5, static_cast<int>(level));
  const Vector3d middle = 2.0 * half * (at.cast<double>().array() + 0.5).matrix();
  const double square = body.CalcSquare(middle);
  const double outer = body.reach + kToCorner * half;
  if (square >= outer * outer) return false;
  const double inner = body.reach - kToCorner * half;
  if (inner > 0.0 && square < inner * inner) return true;
  if (level == 0) return body.CalcCubeDistance(middle, half) < body.reach;
  const Vector3i last = (2 * at.array() + 1).min(SizeOf(level - 1).array() - 1);
  for (int z = 2 * at.z(); z <= last.z(); ++z) {
    for (int y = 2 * at.y(); y <= last.y(); ++y) {
      for (int x = 2 * at.x(); x <= last.x(); ++x) {
        if (IsTouched(body, level - 1, {x, y, z})) return true;
      }
    }
  }
  return false;
}

bool ObstaclePyramid::IsTouched(const Capsule& capsule_W) const {
  const LineBody body{ToCells(capsule_W.p_A), ToCells(capsule_W.p_B), capsule_W.radius_m / grid_.shape().resolution_m};
  return IsTouched(body, levels_.size(), Vector3i::Zero());
}

bool ObstaclePyramid::IsTouched(const Block& block_W, double margin_m) const {
  const double cell_m = grid_.shape().resolution_m;
  Block block{block_W.X_LC, block_W.half / cell_m};
  block.X_LC.translation() = ToCells(block_W.X_LC.translation());
  // What lies in the block itself is touched without a margin, too.
  const BlockBody body{block, std::max(margin_m / cell_m, 1e-9)};
  return IsTouched(body, levels_.size(), Vector3i::Zero());
}

}  // namespace nbs
