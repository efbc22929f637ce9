#include "sim/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "common/geometry/directions.h"
#include "sim/mesh_measures.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr int kSamples = 2;  ///< Per pixel and axis.
constexpr int kOpennessRays = 24;
const Vector3d kStone(0.86, 0.83, 0.78);
const Vector3d kBackSide(0.40, 0.50, 0.72);
const Vector3d kBorder(0.85, 0.10, 0.08);

/// Where the picture's samples lie in W.
struct Camera {
  Vector3d forward, right, up;
  Vector3d corner_W;     ///< Of the sample at row 0, column 0.
  double step_m = 0.0;   ///< Between samples.
  double depth_m = 0.0;  ///< From the plane of the samples to behind the object.

  Vector3d SampleAt(int row, int column) const { return corner_W + step_m * (column * right - row * up); }
};

/// Width and height of what is shown, metres.
std::pair<double, double> CalcExtents(const View& view, const Camera& camera, const Eigen::AlignedBox3d& box) {
  const Vector3d size = box.isEmpty() ? Vector3d::Ones() : Vector3d(box.sizes());
  if (view.tight) return {size.dot(camera.right.cwiseAbs()), size.dot(camera.up.cwiseAbs())};
  const double across = size.head<2>().norm();
  return {across, size.z() * std::cos(view.elevation_rad) + across * std::abs(std::sin(view.elevation_rad))};
}

Camera MakeCamera(const View& view, const Eigen::AlignedBox3d& box) {
  const double ca = std::cos(view.azimuth_rad), sa = std::sin(view.azimuth_rad);
  const double ce = std::cos(view.elevation_rad), se = std::sin(view.elevation_rad);
  Camera camera;
  camera.forward = Vector3d(-sa * ce, ca * ce, -se);
  camera.right = Vector3d(ca, sa, 0.0);
  camera.up = camera.right.cross(camera.forward);
  const auto [across, tall] = CalcExtents(view, camera, box);
  const Vector3d size = box.isEmpty() ? Vector3d::Ones() : Vector3d(box.sizes());
  const Vector3d middle = box.isEmpty() ? Vector3d::Zero() : Vector3d(box.center());
  const double radius = size.norm();
  camera.step_m = 1.04 * std::max(across / view.width, tall / view.height) / kSamples;
  camera.depth_m = 4.0 * radius;
  camera.corner_W = middle - 2.0 * radius * camera.forward -
                    0.5 * camera.step_m * kSamples * view.width * camera.right +
                    0.5 * camera.step_m * kSamples * view.height * camera.up;
  return camera;
}

Vector3d CalcBackground(double height_fraction) { return Vector3d::Constant(0.97 - 0.17 * height_fraction); }

/// Barycentric weights of p in the triangle abc.
Vector3d CalcWeights(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  if (area == 0.0) return Vector3d::Constant(1.0 / 3.0);
  const double u = n.dot((b - p).cross(c - p)) / area;
  const double v = n.dot((c - p).cross(a - p)) / area;
  return {u, v, 1.0 - u - v};
}

uint8_t ToByte(double light) {
  return static_cast<uint8_t>(std::lround(255.0 * std::pow(std::clamp(light, 0.0, 1.0), 1.0 / 1.5)));
}

/// One row of samples after the other, so that memory stays small.
class RowShader {
 public:
  RowShader(const TriangleMesh& mesh, const TriangleScene& scene, const Surface& surface, const Camera& camera)
      : mesh_(mesh), scene_(scene), surface_(surface), camera_(camera) {
    to_light_ = (-0.75 * camera.forward - 0.55 * camera.right + 0.75 * camera.up).normalized();
  }

  /// Colours and depths (from the samples' plane; infinity for the background) of one row.
  void Shade(int row, int rows, std::vector<Vector3d>& colors, std::vector<float>& depths) const {
    std::vector<Ray> rays(colors.size());
    for (size_t i = 0; i < rays.size(); ++i) rays[i] = {camera_.SampleAt(row, static_cast<int>(i)), camera_.forward};
    const std::vector<RayHit> hits = scene_.CastRays(rays, camera_.depth_m);
    std::vector<TriangleScene::Segment> sights(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      const Vector3d p = rays[i].p_W + hits[i].distance_m * rays[i].direction_W;
      const bool may_be_lit = hits[i].hit() && FaceViewer(hits[i].normal_W).dot(to_light_) > -0.2;
      sights[i] = {p, may_be_lit ? Vector3d(p + camera_.depth_m * to_light_) : p};
    }
    const std::vector<uint8_t> shadow = scene_.FindBlocked(sights, 0.5 * camera_.step_m + 5e-4);
    for (size_t i = 0; i < rays.size(); ++i) {
      depths[i] = hits[i].hit() ? static_cast<float>(hits[i].distance_m) : std::numeric_limits<float>::infinity();
      colors[i] = hits[i].hit() ? ShadePoint(sights[i].p_WA, hits[i], shadow[i] != 0)
                                : CalcBackground(static_cast<double>(row) / rows);
    }
  }

 private:
  Vector3d FaceViewer(const Vector3d& normal) const {
    return normal.dot(camera_.forward) > 0.0 ? Vector3d(-normal) : normal;
  }

  Vector3d ShadePoint(const Vector3d& p, const RayHit& hit, bool in_shadow) const {
    const auto& t = mesh_.triangles[hit.triangle];
    const Vector3d weights = CalcWeights(p, mesh_.vertices_W[t[0]].cast<double>(),
                                         mesh_.vertices_W[t[1]].cast<double>(), mesh_.vertices_W[t[2]].cast<double>());
    Vector3d normal = Vector3d::Zero();
    Vector3d color = surface_.colors.empty() ? kStone : Vector3d::Zero();
    double openness = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (!surface_.colors.empty()) color += weights[i] * surface_.colors[t[i]].cast<double>();
      normal += weights[i] * mesh_.normals_W[t[i]].cast<double>();
      openness += weights[i] * surface_.openness[t[i]];
    }
    const bool back = hit.normal_W.dot(camera_.forward) > 0.0;
    if (back) normal = -normal;
    normal.normalize();
    const double key = in_shadow ? 0.0 : std::max(0.0, normal.dot(to_light_));
    const double fill = 0.5 + 0.5 * normal.dot(camera_.up);
    const double light =
        0.62 * key + openness * (0.22 + 0.16 * fill) + 0.10 * std::max(0.0, -normal.dot(camera_.forward));
    return light * (back ? kBackSide : color);
  }

  const TriangleMesh& mesh_;
  const TriangleScene& scene_;
  const Surface& surface_;
  Camera camera_;
  Vector3d to_light_;
};

/// Sums samples to pixels, and keeps the depth at one sample a pixel for the lines.
struct Canvas {
  std::vector<Vector3d> pixels;
  std::vector<float> depths;
  int width = 0, height = 0;
};

Canvas DrawSurface(const View& view, const RowShader& shader) {
  Canvas canvas;
  canvas.width = view.width;
  canvas.height = view.height;
  canvas.pixels.assign(static_cast<size_t>(view.width) * view.height, Vector3d::Zero());
  canvas.depths.resize(canvas.pixels.size());
  std::vector<Vector3d> colors(static_cast<size_t>(view.width) * kSamples);
  std::vector<float> depths(colors.size());
  for (int row = 0; row < view.height * kSamples; ++row) {
    shader.Shade(row, view.height * kSamples, colors, depths);
    const size_t first = static_cast<size_t>(row / kSamples) * view.width;
    for (size_t i = 0; i < colors.size(); ++i) {
      canvas.pixels[first + i / kSamples] += colors[i] / (kSamples * kSamples);
      if (row % kSamples == 0 && i % kSamples == 0) canvas.depths[first + i / kSamples] = depths[i];
    }
  }
  return canvas;
}

/// Draws a line in W, two pixels wide, where nothing is before it.
void DrawLine(const Camera& camera, const Vector3d& p_WA, const Vector3d& p_WB, Canvas& canvas) {
  const double pixel_m = camera.step_m * kSamples;
  const int steps = 1 + static_cast<int>((p_WB - p_WA).norm() / pixel_m * 2.0);
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = p_WA + (p_WB - p_WA) * (static_cast<double>(i) / steps) - camera.corner_W;
    const int column = static_cast<int>(std::floor(p.dot(camera.right) / pixel_m));
    const int row = static_cast<int>(std::floor(-p.dot(camera.up) / pixel_m));
    for (int k = 0; k < 4; ++k) {
      const int x = column + k % 2, y = row + k / 2;
      if (x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) continue;
      const size_t at = static_cast<size_t>(y) * canvas.width + x;
      if (p.dot(camera.forward) <= canvas.depths[at] + 2.0 * pixel_m + 1e-3) canvas.pixels[at] = kBorder;
    }
  }
}

}  // namespace

MeshRenderer::MeshRenderer(const TriangleMesh& mesh_W, Surface surface)
    : mesh_W_(mesh_W), scene_W_(mesh_W), surface_(std::move(surface)) {
  const auto fits = [&](size_t count) { return count == 0 || count == mesh_W_.vertices_W.size(); };
  if (!fits(surface_.colors.size()) || !fits(surface_.openness.size()))
    throw std::invalid_argument("MeshRenderer: a surface of another number of vertices");
  if (mesh_W_.normals_W.empty()) mesh_W_.normals_W = CalcVertexNormals(mesh_W_);
  borders_ = FindBorderEdges(mesh_W_.triangles);
  if (surface_.openness.empty()) CalcOpenness();
}

void MeshRenderer::CalcOpenness() {
  const size_t count = mesh_W_.vertices_W.size();
  const double reach = CalcBoundingBox(mesh_W_).sizes().norm() * 0.5;
  std::vector<double> open(count, 0.0), all(count, 0.0);
  std::vector<TriangleScene::Segment> sights(count);
  for (const Vector3d& direction : MakeSphereDirections(kOpennessRays)) {
    for (size_t v = 0; v < count; ++v) {
      const Vector3d p = mesh_W_.vertices_W[v].cast<double>();
      const bool faces = mesh_W_.normals_W[v].cast<double>().dot(direction) > 0.0;
      sights[v] = {p, faces ? Vector3d(p + reach * direction) : p};
    }
    const std::vector<uint8_t> blocked = scene_W_.FindBlocked(sights, 2e-3 * reach);
    for (size_t v = 0; v < count; ++v) {
      const double weight = std::max(0.0, mesh_W_.normals_W[v].cast<double>().dot(direction));
      all[v] += weight;
      if (blocked[v] == 0) open[v] += weight;
    }
  }
  surface_.openness.resize(count);
  for (size_t v = 0; v < count; ++v) surface_.openness[v] = all[v] > 0.0 ? static_cast<float>(open[v] / all[v]) : 1.0f;
}

Picture MeshRenderer::Render(const View& view) const {
  const Camera camera = MakeCamera(view, view.frame_W.value_or(CalcBoundingBox(mesh_W_)));
  Canvas canvas = DrawSurface(view, RowShader(mesh_W_, scene_W_, surface_, camera));
  if (view.mark_borders) {
    for (const BorderEdge& edge : borders_) {
      DrawLine(camera, mesh_W_.vertices_W[edge.from].cast<double>(), mesh_W_.vertices_W[edge.to].cast<double>(),
               canvas);
    }
  }
  Picture picture{view.width, view.height, {}};
  picture.rgb.reserve(canvas.pixels.size() * 3);
  for (const Vector3d& color : canvas.pixels) {
    for (int channel = 0; channel < 3; ++channel) picture.rgb.push_back(ToByte(color[channel]));
  }
  return picture;
}

std::vector<uint8_t> MeshRenderer::FindHidden(const std::vector<Vector3d>& points_W, const View& view) const {
  const Camera camera = MakeCamera(view, view.frame_W.value_or(CalcBoundingBox(mesh_W_)));
  constexpr double kSkip_m = 0.002;
  std::vector<TriangleScene::Segment> sights;
  for (const Vector3d& p : points_W) sights.push_back({p, p - camera.depth_m * camera.forward});
  return scene_W_.FindBlocked(sights, kSkip_m);
}

Projection::Projection(const View& view, const Eigen::AlignedBox3d& box_W) {
  const Camera camera = MakeCamera(view, view.frame_W.value_or(box_W));
  right_W_ = camera.right;
  down_W_ = -camera.up;
  corner_W_ = camera.corner_W;
  pixel_m_ = camera.step_m * kSamples;
}

Eigen::Vector2d Projection::Project(const Vector3d& p_W) const {
  return Eigen::Vector2d(right_W_.dot(p_W - corner_W_), down_W_.dot(p_W - corner_W_)) / pixel_m_;
}

}  // namespace nbs
