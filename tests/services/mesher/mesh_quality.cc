#include "tests/services/mesher/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/runtime/counter_random.h"
#include "services/mesher/brick_grid.h"
#include "sim/mesh_measures.h"
#include "tests/services/mesher/shape_scan.h"

namespace nbs {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest_m = 0.01;
constexpr int kLeastMeasurements = 3;
constexpr float kMeasuredWithin_m = 0.0015f;
const double kLeastCosine = std::cos(75.0 * std::numbers::pi / 180.0);

struct HalfEdge {
  uint32_t low, high;
  bool forward;  ///< From low to high.
};

std::vector<HalfEdge> CollectHalfEdges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return edges;
}

void CountEdges(const TriangleMesh& mesh, MeshQuality& quality) {
  const std::vector<HalfEdge> edges = CollectHalfEdges(mesh);
  std::vector<int> borders(mesh.vertices_W.size(), 0);
  for (size_t i = 0; i < edges.size();) {
    size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    const double length = (mesh.vertices_W[edges[i].low] - mesh.vertices_W[edges[i].high]).norm();
    quality.mean_edge_m += length;
    quality.longest_edge_m = std::max(quality.longest_edge_m, length);
    ++quality.edges;
    if (end - i == 1) {
      ++quality.border_edges;
      ++borders[edges[i].low];
      ++borders[edges[i].high];
    }
    if (end - i > 2) ++quality.non_manifold_edges;
    if (end - i == 2 && edges[i].forward == edges[i + 1].forward) ++quality.flipped_edges;
    i = end;
  }
  for (int count : borders) quality.non_manifold_vertices += count > 2;
  if (quality.edges == 0) return;
  quality.mean_edge_m /= static_cast<double>(quality.edges);
  quality.completeness = 1.0 - static_cast<double>(quality.border_edges) / static_cast<double>(quality.edges);
}

bool IsDegenerate(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  constexpr float kLeastHeight = 1e-3f;
  const Eigen::Vector3f u = mesh.vertices_W[t[1]] - mesh.vertices_W[t[0]],
                        v = mesh.vertices_W[t[2]] - mesh.vertices_W[t[0]];
  return !(u.cross(v).norm() > kLeastHeight * std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()}));
}

}  // namespace

MeshQuality CalcTopologyFigures(const TriangleMesh& mesh_W) {
  MeshQuality quality;
  quality.triangles = static_cast<int64_t>(mesh_W.triangles.size());
  for (const auto& t : mesh_W.triangles) quality.degenerate_triangles += IsDegenerate(mesh_W, t);
  CountEdges(mesh_W, quality);
  return quality;
}

QualityOracle::QualityOracle(const Shape& shape, const Profiler& profiler, std::span<const Stripe> stripes, int samples)
    : sheets_(shape.sheets), ridges_W_(shape.ridges_W), truth_W_(shape.mesh_W), grid_(kMeasuredWithin_m) {
  PlaceSamples(shape.mesh_W, samples);
  for (const Sample& sample : samples_) {
    int32_t& head = grid_.Touch(sample.p_W.cast<float>());
    next_.push_back(head);
    head = static_cast<int32_t>(next_.size()) - 1;
  }
  CountMeasurements(profiler, stripes);
}

void QualityOracle::PlaceSamples(const TriangleMesh& mesh_W, int count) {
  const double share = CalcArea(mesh_W) / count;
  double area = 0.0;
  for (const auto& t : mesh_W.triangles) {
    const Vector3d a = mesh_W.vertices_W[t[0]].cast<double>(), u = mesh_W.vertices_W[t[1]].cast<double>() - a,
                   v = mesh_W.vertices_W[t[2]].cast<double>() - a;
    for (area += 0.5 * u.cross(v).norm(); area > share; area -= share) {
      const double r = std::sqrt(CalcUniform({7, samples_.size(), 0})), s = CalcUniform({7, samples_.size(), 1});
      samples_.push_back({a + r * (1.0 - s) * u + r * s * v, u.cross(v).normalized(), 0});
    }
  }
}

void QualityOracle::CountMeasurements(const Profiler& profiler, std::span<const Stripe> stripes) {
  constexpr double kFarthestHit_m = 0.005;  // An outlier is no measurement of the surface behind it.
  const std::vector<Vector3d> directions_S = CalcBeamDirections_S(profiler);
  std::vector<Ray> rays;
  for (const Stripe& stripe : stripes) {
    if (stripe.end_of_scan) continue;
    rays.clear();
    for (const Vector3d& d : directions_S) rays.push_back({stripe.X_WS.translation(), stripe.X_WS.linear() * d});
    const std::vector<RayHit> hits = truth_W_.CastRays(rays, 2.0 * profiler.max_depth_m);
    for (size_t i = 0; i < rays.size(); ++i) {
      if (stripe.ranges_m[i] == 0.0f || std::abs(hits[i].distance_m - stripe.ranges_m[i]) > kFarthestHit_m) continue;
      const Vector3d p_W = rays[i].p_W + hits[i].distance_m * rays[i].direction_W;
      ForEachSampleNear(p_W, kMeasuredWithin_m, [&](int32_t k) {
        if (samples_[k].normal_W.dot(hits[i].normal_W) >= kLeastCosine) ++samples_[k].measurements;
      });
    }
  }
}

MeshQuality QualityOracle::Evaluate(const TriangleMesh& mesh_W) const {
  MeshQuality quality = CalcTopologyFigures(mesh_W);
  if (quality.triangles == 0) return quality;
  CompareVertices(mesh_W, quality);
  CompareSamples(mesh_W, quality);
  CompareRidges(mesh_W, quality);
  CompareBorder(mesh_W, quality);
  return quality;
}

void QualityOracle::CompareVertices(const TriangleMesh& mesh_W, MeshQuality& quality) const {
  const std::vector<Eigen::Vector3f> normals = mesh_W.normals_W.empty() ? CalcVertexNormals(mesh_W) : mesh_W.normals_W;
  constexpr int kUnknown = -1;
  std::vector<int> sheet(mesh_W.vertices_W.size(), kUnknown);
  std::vector<uint8_t> used(mesh_W.vertices_W.size(), 0);
  for (const auto& t : mesh_W.triangles) {
    for (uint32_t v : t) used[v] = 1;
  }
  double squares = 0.0;
  int64_t count = 0;
  for (size_t i = 0; i < sheet.size(); ++i) {
    if (used[i] == 0) continue;
    const Vector3d p_W = mesh_W.vertices_W[i].cast<double>();
    const auto closest = truth_W_.FindClosest(p_W, kFarthest_m);
    const double error = closest ? closest->distance_m : kFarthest_m;
    squares += error * error;
    quality.largest_error_m = std::max(quality.largest_error_m, error);
    ++count;
    const auto facing = truth_W_.FindClosestFacing(p_W, kFarthest_m, normals[i].cast<double>(), 0.5);
    if (facing) sheet[i] = sheets_[facing->triangle];
  }
  quality.rms_error_m = std::sqrt(squares / static_cast<double>(count));
  for (const auto& t : mesh_W.triangles) {
    int first = 0;
    for (uint32_t v : t) {
      if (sheet[v] <= 0 || first == sheet[v]) continue;
      if (first > 0) {
        ++quality.joining_triangles;
        break;
      }
      first = sheet[v];
    }
  }
}

void QualityOracle::CompareSamples(const TriangleMesh& mesh_W, MeshQuality& quality) const {
  constexpr double kNear_m = 0.002;
  const TriangleScene scene_W(mesh_W);
  int64_t measured = 0, covered = 0;
  for (const Sample& sample : samples_) {
    if (sample.measurements < kLeastMeasurements) continue;
    ++measured;
    covered += scene_W.FindClosestFacing(sample.p_W, kNear_m, sample.normal_W, kLeastCosine).has_value();
  }
  quality.measured = static_cast<double>(measured) / static_cast<double>(samples_.size());
  if (measured > 0) quality.coverage = static_cast<double>(covered) / static_cast<double>(measured);
}

void QualityOracle::CompareRidges(const TriangleMesh& mesh_W, MeshQuality& quality) const {
  const TriangleScene scene_W(mesh_W);
  for (const Vector3d& p_W : ridges_W_) {
    bool measured = true;
    ForEachSampleNear(p_W, kMeasuredWithin_m,
                      [&](int32_t k) { measured = measured && samples_[k].measurements >= kLeastMeasurements; });
    if (!measured) continue;
    const auto closest = scene_W.FindClosest(p_W, kFarthest_m);
    quality.ridge_gap_m = std::max(quality.ridge_gap_m, closest ? closest->distance_m : kFarthest_m);
  }
}

void QualityOracle::CompareBorder(const TriangleMesh& mesh_W, MeshQuality& quality) const {
  constexpr float kNear_m = 0.004f;
  const std::vector<HalfEdge> edges = CollectHalfEdges(mesh_W);
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto same = [&](size_t k) {
      return k < edges.size() && edges[k].low == edges[i].low && edges[k].high == edges[i].high;
    };
    if (same(i + 1) || (i > 0 && same(i - 1))) continue;
    const Vector3d p_W = 0.5 * (mesh_W.vertices_W[edges[i].low] + mesh_W.vertices_W[edges[i].high]).cast<double>();
    bool measured = true;
    ForEachSampleNear(p_W, kNear_m,
                      [&](int32_t k) { measured = measured && samples_[k].measurements >= kLeastMeasurements; });
    quality.spurious_border_edges += measured;
  }
}

}  // namespace nbs
