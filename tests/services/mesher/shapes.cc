#include "tests/services/mesher/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/geometry/mesh_io.h"
#include "sim/objects/statue.h"

namespace nbs {
namespace {

constexpr uint32_t kSegments = 360;

/// Numbers of the vertices that a point of the contour sweeps out: one on the axis, kSegments off it.
std::vector<uint32_t> AddRing(const ContourPoint& point, TriangleMesh& mesh) {
  std::vector<uint32_t> ring;
  const bool on_axis = point.r_m == 0.0;
  for (uint32_t i = 0; i < (on_axis ? 1 : kSegments); ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSegments;
    ring.push_back(static_cast<uint32_t>(mesh.vertices_W.size()));
    mesh.vertices_W.push_back(
        Eigen::Vector3d(point.r_m * std::cos(angle), point.r_m * std::sin(angle), point.z_m).cast<float>());
  }
  return ring;
}

void AddBand(const std::vector<uint32_t>& low, const std::vector<uint32_t>& high, int sheet, Shape& shape) {
  const auto at = [](const std::vector<uint32_t>& ring, uint32_t i) { return ring[i % ring.size()]; };
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    if (a == b || b == c || c == a) return;
    shape.mesh_W.triangles.push_back({a, b, c});
    shape.sheets.push_back(sheet);
  };
  for (uint32_t i = 0; i < kSegments; ++i) {
    add(at(low, i), at(low, i + 1), at(high, i));
    add(at(low, i + 1), at(high, i + 1), at(high, i));
  }
}

/// Points from a to b at most 2 mm apart, b left out.
void AppendLine(const ContourPoint& a, const ContourPoint& b, std::vector<ContourPoint>& contour) {
  const int count = static_cast<int>(std::ceil(std::hypot(b.r_m - a.r_m, b.z_m - a.z_m) / 0.002));
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / count;
    contour.push_back({a.r_m + t * (b.r_m - a.r_m), a.z_m + t * (b.z_m - a.z_m)});
  }
}

/// A face of the box in cells of about 5 mm: u x v points outwards.
void AddFace(const Eigen::Vector3d& middle, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int sheet,
             double margin_m, Shape& shape) {
  const int n = std::max(1, static_cast<int>(u.norm() / 0.0025)), m = std::max(1, static_cast<int>(v.norm() / 0.0025));
  const auto first = static_cast<uint32_t>(shape.mesh_W.vertices_W.size());
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j)
      shape.mesh_W.vertices_W.push_back((middle + (2.0 * i / n - 1.0) * u + (2.0 * j / m - 1.0) * v).cast<float>());
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const uint32_t a = first + static_cast<uint32_t>(i * (m + 1) + j), b = a + static_cast<uint32_t>(m) + 1;
      const double to_rim = std::min((1.0 - std::abs((2.0 * i + 1.0) / n - 1.0)) * u.norm(),
                                     (1.0 - std::abs((2.0 * j + 1.0) / m - 1.0)) * v.norm());
      shape.mesh_W.triangles.push_back({a, b, b + 1});
      shape.mesh_W.triangles.push_back({a, b + 1, a + 1});
      shape.sheets.insert(shape.sheets.end(), 2, to_rim > margin_m ? sheet : 0);
    }
  }
}

/// From a to b, both ends included.
void AddRidge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Shape& shape) {
  const int count = static_cast<int>(std::ceil((b - a).norm() / 0.0005));
  for (int i = 0; i <= count; ++i) shape.ridges_W.push_back(a + static_cast<double>(i) / count * (b - a));
}

}  // namespace

Shape MakeRevolved(std::span<const ContourPoint> contour, bool ring, const std::function<int(size_t)>& sheet_of) {
  Shape shape;
  std::vector<std::vector<uint32_t>> rings;
  for (const ContourPoint& point : contour) rings.push_back(AddRing(point, shape.mesh_W));
  for (size_t i = 0; i + 1 < rings.size(); ++i) AddBand(rings[i], rings[i + 1], sheet_of(i), shape);
  if (ring) AddBand(rings.back(), rings.front(), sheet_of(rings.size() - 1), shape);
  return shape;
}

Shape MakeSphere(double radius_m) {
  constexpr int kSteps = 180;
  std::vector<ContourPoint> contour;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / kSteps - 0.5);
    contour.push_back({i == 0 || i == kSteps ? 0.0 : radius_m * std::cos(angle), radius_m * std::sin(angle)});
  }
  return MakeRevolved(contour, false, [](size_t) { return 0; });
}

Shape MakeTorus(double radius_m, double tube_radius_m) {
  constexpr int kSteps = 120;
  std::vector<ContourPoint> contour;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    contour.push_back({radius_m + tube_radius_m * std::cos(angle), tube_radius_m * std::sin(angle)});
  }
  return MakeRevolved(contour, true, [](size_t) { return 0; });
}

Shape MakeBox(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& half_m, int first_sheet, double margin_m) {
  Shape shape;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d n = half_m[axis] * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d u = half_m[(axis + 1) % 3] * Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d v = half_m[(axis + 2) % 3] * Eigen::Vector3d::Unit((axis + 2) % 3);
    AddFace(centre_W + n, u, v, axis == 2 ? first_sheet : 0, margin_m, shape);
    AddFace(centre_W - n, v, u, axis == 2 ? first_sheet + 1 : 0, margin_m, shape);
    for (const double side : {-1.0, 1.0}) {
      AddRidge(centre_W + side * u + v - n, centre_W + side * u + v + n, shape);
      AddRidge(centre_W + side * u - v - n, centre_W + side * u - v + n, shape);
    }
  }
  return shape;
}

Shape MakePrism(std::span<const Eigen::Vector2d> polygon_m, double half_height_m) {
  Shape shape;
  const Eigen::Vector3d up = half_height_m * Eigen::Vector3d::UnitZ();
  const auto at = [&](size_t i) {
    const Eigen::Vector2d& p = polygon_m[i % polygon_m.size()];
    return Eigen::Vector3d(p.x(), p.y(), 0.0);
  };
  for (size_t i = 0; i < polygon_m.size(); ++i) {
    const Eigen::Vector3d half = 0.5 * (at(i + 1) - at(i));
    AddFace(at(i) + half, half, up, 0, 0.0, shape);
    for (const double side : {-1.0, 1.0}) AddRidge(at(i) + side * up, at(i + 1) + side * up, shape);
    AddRidge(at(i) - up, at(i) + up, shape);
  }
  for (const double side : {-1.0, 1.0}) {
    const auto first = static_cast<uint32_t>(shape.mesh_W.vertices_W.size());
    for (size_t i = 0; i < polygon_m.size(); ++i) shape.mesh_W.vertices_W.push_back((at(i) + side * up).cast<float>());
    for (uint32_t i = 1; i + 1 < polygon_m.size(); ++i) {
      const uint32_t b = first + i, c = b + 1;
      shape.mesh_W.triangles.push_back({first, side > 0.0 ? b : c, side > 0.0 ? c : b});
      shape.sheets.push_back(0);
    }
  }
  return shape;
}

Shape Turn(const Eigen::Matrix3d& R, Shape shape) {
  for (Eigen::Vector3f& v : shape.mesh_W.vertices_W) v = R.cast<float>() * v;
  for (Eigen::Vector3d& p_W : shape.ridges_W) p_W = R * p_W;
  return shape;
}

Shape MakeCup(const CupSettings& settings) {
  const double inner = settings.radius_m - settings.wall_m;
  std::vector<ContourPoint> contour;
  AppendLine({0.0, 0.0}, {settings.radius_m, 0.0}, contour);
  AppendLine({settings.radius_m, 0.0}, {settings.radius_m, settings.height_m}, contour);
  const size_t lip = contour.size();
  AppendLine({settings.radius_m, settings.height_m}, {inner, settings.height_m}, contour);
  AppendLine({inner, settings.height_m}, {inner, settings.wall_m}, contour);
  AppendLine({inner, settings.wall_m}, {0.0, settings.wall_m}, contour);
  contour.push_back({0.0, settings.wall_m});
  return MakeRevolved(contour, false, [&](size_t i) {
    if (contour[i].z_m > settings.height_m - settings.margin_m) return 0;
    return i < lip ? 1 : 2;
  });
}

Shape Join(const Shape& a, const Shape& b) {
  Shape both = a;
  const auto first = static_cast<uint32_t>(a.mesh_W.vertices_W.size());
  both.mesh_W.vertices_W.insert(both.mesh_W.vertices_W.end(), b.mesh_W.vertices_W.begin(), b.mesh_W.vertices_W.end());
  for (const auto& t : b.mesh_W.triangles) both.mesh_W.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  both.sheets.insert(both.sheets.end(), b.sheets.begin(), b.sheets.end());
  both.ridges_W.insert(both.ridges_W.end(), b.ridges_W.begin(), b.ridges_W.end());
  return both;
}

Shape MakeShapeByName(const std::string& name) {
  constexpr double kMargin_m = 0.01;
  const Eigen::Vector3d plate(0.05, 0.05, 0.0015);
  if (name == "sphere") return MakeSphere(0.06);
  if (name == "torus") return MakeTorus(0.05, 0.02);
  if (name == "cube") return MakeBox(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.04), 0, 1.0);
  if (name == "plate") return MakeBox(Eigen::Vector3d::Zero(), plate, 1, kMargin_m);
  if (name == "plates")
    return Join(MakeBox({0.0, 0.0, 0.0045}, plate, 1, kMargin_m), MakeBox({0.0, 0.0, -0.0045}, plate, 3, kMargin_m));
  if (name == "cup") return MakeCup({});
  const Eigen::Matrix3d askew =
      (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  if (name == "brick") return Turn(askew, MakeBox(Eigen::Vector3d::Zero(), {0.045, 0.025, 0.01}, 0, 1.0));
  if (name == "wedge")
    return Turn(askew,
                MakePrism(std::array<Eigen::Vector2d, 3>{{{-0.03, -0.02}, {0.03, -0.02}, {0.0026, 0.0268}}}, 0.03));
  Shape shape;
  shape.mesh_W = name == "statue" ? MakeStatue() : ReadMesh(name);
  shape.sheets.assign(shape.mesh_W.triangles.size(), 0);
  return shape;
}

}  // namespace nbs
