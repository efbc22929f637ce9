#include "sim/objects/statue.h"

#include "sim/mesh_measures.h"
#include "sim/objects/isosurface.h"
#include "sim/objects/statue_parts.h"

namespace nbs {
namespace {

constexpr double kHeight_m = 0.5;
constexpr double kSpacing_mm = 2.2;

SdfShape SculptStatue() {
  SdfShape shape;
  Sculptor s(shape);
  SculptPlinth(s);
  SculptLegs(s);
  SculptTorso(s);
  SculptArms(s);
  SculptHead(s);
  SculptHair(s);
  SculptCloth(s);
  SculptWings(s);
  SculptBowl(s);
  return shape;
}

/// Millimetres to metres, base to z = 0, height to 500 mm, bounding box to the middle.
void Settle(TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = CalcBoundingBox(mesh);
  const double scale = kHeight_m / box.sizes().z();
  const Eigen::Vector3d origin(box.center().x(), box.center().y(), box.min().z());
  for (Eigen::Vector3f& p : mesh.vertices_W) p = (scale * (p.cast<double>() - origin)).cast<float>();
}

}  // namespace

TriangleMesh MakeStatue() {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-152, -110, -8), Eigen::Vector3d(150, 120, 512));
  // Hollows that the solids happen to enclose are pieces of their own.
  TriangleMesh mesh = KeepLargestPiece(MeshShape(SculptStatue(), box, {.spacing = kSpacing_mm}));
  Settle(mesh);
  mesh.normals_W = CalcVertexNormals(mesh);
  return mesh;
}

}  // namespace nbs
