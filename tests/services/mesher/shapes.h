#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs {

/// A closed surface with a known answer, counter-clockwise seen from outside.
///
/// Each triangle names the sheet it lies on. Triangles near a rim, where sheets rightly meet, lie on sheet 0; so does
/// all of a shape that is one sheet.
struct Shape {
  TriangleMesh mesh_W;
  std::vector<int> sheets;  ///< One a triangle.
  /// Points along the sharp edges that stand out, half a millimetre apart, the corners among them.
  std::vector<Eigen::Vector3d> ridges_W;
};

/// A point of a contour in the half-plane of a solid of revolution, metres.
struct ContourPoint {
  double r_m = 0.0;
  double z_m = 0.0;
};

/// Turns a contour about z. It runs counter-clockwise in (r, z), the solid on its left: from the lower point of the
/// axis to the upper one, or, if `ring`, in a loop off the axis.
///
/// @param sheet_of  Sheet of the contour's part from point i to point i + 1.
Shape MakeRevolved(std::span<const ContourPoint> contour, bool ring, const std::function<int(size_t)>& sheet_of);

Shape MakeSphere(double radius_m);
Shape MakeTorus(double radius_m, double tube_radius_m);

/// Axis-parallel box about `centre_W`. Its upper face (z) lies on sheet first_sheet, its lower one on the next, both
/// only where `margin_m` away from the rim.
Shape MakeBox(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& half_m, int first_sheet, double margin_m);

/// Upright prism over a convex polygon in the xy plane, counter-clockwise; from z = -half_height_m to half_height_m.
Shape MakePrism(std::span<const Eigen::Vector2d> polygon_m, double half_height_m);

/// Turns the shape about the origin.
Shape Turn(const Eigen::Matrix3d& R, Shape shape);

/// A cup that opens upwards: sheet 1 is the outer side, sheet 2 the inner one, `margin_m` away from the lip.
struct CupSettings {
  double radius_m = 0.045;
  double height_m = 0.06;
  double wall_m = 0.004;
  double margin_m = 0.01;
};
Shape MakeCup(const CupSettings& settings);

Shape Join(const Shape& a, const Shape& b);

/// sphere (radius 60 mm), torus (50 mm, tube 20 mm), cube (80 mm), plate (100 x 100 x 3 mm), plates (two, 6 mm apart),
/// cup, statue, brick (90 x 50 x 20 mm) and wedge (60 mm long, corners of 55, 60 and 65 degrees), both turned askew;
/// anything else is the name of a mesh file.
///
/// @throws ConfigError as ReadMesh.
Shape MakeShapeByName(const std::string& name);

}  // namespace nbs
