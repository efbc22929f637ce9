#include "sim/objects/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/objects/sample_grid.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

/// The mesh on its way: double precision, quadrilaterals.
struct Net {
  std::vector<Vector3d> vertices;
  std::vector<std::array<uint32_t, 4>> quads;
};

/// Mean of the points where the surface crosses the cell's edges; false if it crosses none.
bool FindCellVertex(const SampleGrid& grid, int x, int y, int z, Vector3d& vertex) {
  Vector3d sum = Vector3d::Zero();
  int crossings = 0;
  for (int a = 0; a < 8; ++a) {
    for (int bit : {1, 2, 4}) {
      if ((a & bit) != 0) continue;
      const int b = a | bit;
      const size_t index_a = grid.Index(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2 & 1));
      const size_t index_b = grid.Index(x + (b & 1), y + (b >> 1 & 1), z + (b >> 2 & 1));
      if (grid.inside(index_a) == grid.inside(index_b)) continue;
      const double value_a = grid.value(index_a), value_b = grid.value(index_b);
      const double fraction = std::clamp(value_a / (value_a - value_b), 0.05, 0.95);
      const Vector3d p_a = grid.Position(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2 & 1));
      const Vector3d p_b = grid.Position(x + (b & 1), y + (b >> 1 & 1), z + (b >> 2 & 1));
      sum += p_a + fraction * (p_b - p_a);
      ++crossings;
    }
  }
  if (crossings > 0) vertex = sum / crossings;
  return crossings > 0;
}

Net MakeNet(const SampleGrid& grid) {
  Net net;
  const auto& size = grid.size();
  std::vector<uint32_t> vertex_of(static_cast<size_t>(size[0]) * size[1] * size[2], 0xffffffffu);
  for (int z = 0; z + 1 < size[2]; ++z) {
    for (int y = 0; y + 1 < size[1]; ++y) {
      for (int x = 0; x + 1 < size[0]; ++x) {
        Vector3d vertex;
        if (!FindCellVertex(grid, x, y, z, vertex)) continue;
        vertex_of[grid.Index(x, y, z)] = static_cast<uint32_t>(net.vertices.size());
        net.vertices.push_back(vertex);
      }
    }
  }
  // A face for each edge between an inner and an outer sample, out of the four cells around the edge.
  for (int z = 1; z + 1 < size[2]; ++z) {
    for (int y = 1; y + 1 < size[1]; ++y) {
      for (int x = 1; x + 1 < size[0]; ++x) {
        const bool here = grid.inside(grid.Index(x, y, z));
        const std::array<size_t, 3> next = {grid.Index(x + 1, y, z), grid.Index(x, y + 1, z), grid.Index(x, y, z + 1)};
        for (int axis = 0; axis < 3; ++axis) {
          if (here == grid.inside(next[axis])) continue;
          std::array<int, 3> u{}, v{};
          u[(axis + 1) % 3] = 1;
          v[(axis + 2) % 3] = 1;
          const auto cell = [&](int i, int j) {
            return vertex_of[grid.Index(x - i * u[0] - j * v[0], y - i * u[1] - j * v[1], z - i * u[2] - j * v[2])];
          };
          // Counter-clockwise seen from the axis' far end, which is outside if this sample is inside.
          std::array<uint32_t, 4> quad = {cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)};
          if (!here) std::reverse(quad.begin(), quad.end());
          net.quads.push_back(quad);
        }
      }
    }
  }
  return net;
}

/// One Newton step towards the surface, no longer than one spacing.
Vector3d StepToSurface(const SdfShape& shape, const SampleGrid& grid, const Vector3d& p, double spacing) {
  const std::vector<uint16_t>& steps = grid.StepsAt(p);
  const SdfShape::Slope slope = shape.CalcSlope(p, steps, 0.01 * spacing);
  const double squared = slope.gradient.squaredNorm();
  if (squared < 1e-3) return p;
  Vector3d step = -slope.distance / squared * slope.gradient;
  const double length = step.norm();
  if (length > spacing) step *= spacing / length;
  return p + step;
}

/// Moves each vertex half-way to the mean of its neighbours, then back towards the surface.
void Relax(const SdfShape& shape, const SampleGrid& grid, double spacing, Net& net) {
  std::vector<Vector3d> sums(net.vertices.size(), Vector3d::Zero());
  std::vector<int> counts(net.vertices.size(), 0);
  for (const auto& quad : net.quads) {
    for (int i = 0; i < 4; ++i) {
      sums[quad[i]] += net.vertices[quad[(i + 1) % 4]];
      ++counts[quad[i]];
    }
  }
  for (size_t v = 0; v < net.vertices.size(); ++v) {
    const Vector3d middle = sums[v] / std::max(counts[v], 1);
    net.vertices[v] = StepToSurface(shape, grid, 0.5 * (net.vertices[v] + middle), spacing);
  }
}

/// Smallest cosine-free measure of a triangle's shape: twice its area over its longest edge squared.
double CalcShape(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() / std::max(longest, 1e-300);
}

/// Cuts each quadrilateral along the diagonal that gives the better worse triangle.
TriangleMesh Triangulate(const Net& net) {
  TriangleMesh mesh;
  mesh.vertices_W.reserve(net.vertices.size());
  for (const Vector3d& p : net.vertices) mesh.vertices_W.push_back(p.cast<float>());
  mesh.triangles.reserve(2 * net.quads.size());
  for (const auto& q : net.quads) {
    const auto& v = net.vertices;
    const double first = std::min(CalcShape(v[q[0]], v[q[1]], v[q[2]]), CalcShape(v[q[0]], v[q[2]], v[q[3]]));
    const double second = std::min(CalcShape(v[q[1]], v[q[2]], v[q[3]]), CalcShape(v[q[1]], v[q[3]], v[q[0]]));
    const int turn = first >= second ? 0 : 1;
    mesh.triangles.push_back({q[turn], q[turn + 1], q[(turn + 2)]});
    mesh.triangles.push_back({q[turn], q[turn + 2], q[(turn + 3) % 4]});
  }
  return mesh;
}

}  // namespace

TriangleMesh MeshShape(const SdfShape& shape, const Eigen::AlignedBox3d& box, const IsosurfaceSettings& settings) {
  SampleGrid grid(shape, box, settings.spacing);
  grid.MakeWellComposed();
  Net net = MakeNet(grid);
  for (int i = 0; i < settings.relax_iterations; ++i) Relax(shape, grid, settings.spacing, net);
  for (Vector3d& vertex : net.vertices) vertex = StepToSurface(shape, grid, vertex, settings.spacing);
  return Triangulate(net);
}

}  // namespace nbs
