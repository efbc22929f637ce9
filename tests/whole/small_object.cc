#include "tests/whole/small_object.h"

#include <cmath>
#include <numbers>

namespace nbs {
namespace {

constexpr int kRings = 60, kSides = 90;

/// Radius over the direction: 40 mm, and a bump of 12 mm on one side.
double CalcRadius(double polar, double azimuth) {
  const double bump = std::exp(-4.0 * (std::pow(polar - 1.2, 2) + std::pow(azimuth - 2.0, 2)));
  return 0.040 + 0.012 * bump;
}

}  // namespace

TriangleMesh MakeSmallObject() {
  TriangleMesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const int sides = ring == 0 || ring == kRings ? 1 : kSides;
    for (int side = 0; side < sides; ++side) {
      const double polar = std::numbers::pi * ring / kRings, azimuth = 2.0 * std::numbers::pi * side / kSides;
      const double radius = sides == 1 ? 0.040 : CalcRadius(polar, azimuth);
      mesh.vertices_W.emplace_back(radius * std::sin(polar) * std::cos(azimuth),
                                   radius * std::sin(polar) * std::sin(azimuth), radius * std::cos(polar));
    }
  }
  const auto vertex = [](int ring, int side) -> uint32_t {
    if (ring == 0) return 0;
    if (ring == kRings) return 1 + (kRings - 1) * kSides;
    return 1 + (ring - 1) * kSides + side % kSides;
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int side = 0; side < kSides; ++side) {
      const uint32_t a = vertex(ring, side), b = vertex(ring + 1, side);
      const uint32_t c = vertex(ring + 1, side + 1), d = vertex(ring, side + 1);
      if (ring > 0) mesh.triangles.push_back({a, b, d});
      if (ring < kRings - 1) mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

}  // namespace nbs
