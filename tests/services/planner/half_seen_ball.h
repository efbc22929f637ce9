#pragma once

#include <cmath>
#include <numbers>

#include "common/geometry/mesh_delta.h"
#include "common/mapping/ray_walk.h"
#include "common/mapping/voxel_grid.h"

namespace nbs {

/// A ball of 60 mm around the world's origin, of which the half towards +z has been seen by a sensor above it: mesh,
/// occupied voxels on the surface, free ones above it, and never observed ones below and beside.
struct HalfSeenBall {
  static constexpr double kRadius_m = 0.060;
  static constexpr double kVoxel_m = 0.005;

  MeshReplica mesh;
  VoxelGrid voxels{{Eigen::Vector3d::Constant(-0.1), kVoxel_m, Eigen::Vector3i::Constant(40)}};

  /// @param seen_rad  Angle from +z down to which the ball has been seen.
  explicit HalfSeenBall(double seen_rad = 0.5 * std::numbers::pi) {
    MakeMesh(seen_rad);
    for (int z = 0; z < 40; ++z) {
      for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) SetVoxel(x, y, z, seen_rad);
      }
    }
  }

 private:
  /// Rings of 120 vertices around the pole at +z.
  void MakeMesh(double seen_rad) {
    constexpr int kSides = 120;
    const int rings = static_cast<int>(seen_rad * kRadius_m / 0.003);
    MeshDelta delta;
    const auto add_vertex = [&delta](double down, double around) {
      MeshVertex v;
      v.id = static_cast<uint32_t>(delta.vertices.size());
      v.normal_W = Eigen::Vector3d(std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down))
                       .cast<float>();
      v.p_W = static_cast<float>(kRadius_m) * v.normal_W;
      v.measurements = 1;
      delta.vertices.push_back(v);
    };
    const auto add_triangle = [&delta](uint32_t a, uint32_t b, uint32_t c) {
      delta.triangles.push_back({static_cast<uint32_t>(delta.triangles.size()), {a, b, c}});
    };
    add_vertex(0.0, 0.0);
    for (int ring = 1; ring <= rings; ++ring) {
      for (int side = 0; side < kSides; ++side)
        add_vertex(seen_rad * ring / rings, 2.0 * std::numbers::pi * side / kSides);
    }
    for (uint32_t side = 0; side < kSides; ++side) {
      const uint32_t next = (side + 1) % kSides;
      add_triangle(0, 1 + side, 1 + next);
      for (uint32_t ring = 1; ring < static_cast<uint32_t>(rings); ++ring) {
        const uint32_t inner = 1 + (ring - 1) * kSides, outer = inner + kSides;
        add_triangle(inner + side, outer + side, outer + next);
        add_triangle(inner + side, outer + next, inner + next);
      }
    }
    mesh.Apply(delta);
  }

  void SetVoxel(int x, int y, int z, double seen_rad) {
    const Eigen::Vector3d p_W = Eigen::Vector3d::Constant(-0.1) + kVoxel_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
    const double distance = p_W.norm(), down = std::acos(p_W.z() / distance);
    const bool above = std::hypot(p_W.x(), p_W.y()) < kRadius_m * std::sin(std::min(seen_rad, 0.5 * std::numbers::pi));
    int16_t& cell = voxels.cells()[voxels.shape().Index(x, y, z)];
    if (std::abs(distance - kRadius_m) < 0.5 * kVoxel_m && down < seen_rad) {
      cell = 2 * kOccupiedLogOdds;
    } else if (distance > kRadius_m && ((above && p_W.z() > 0.0) || down < seen_rad - 0.5 * std::numbers::pi)) {
      cell = -4000;
    }
  }
};

}  // namespace nbs
