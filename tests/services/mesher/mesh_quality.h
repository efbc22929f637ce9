#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/sensing/profiler.h"
#include "services/mesher/brick_grid.h"
#include "sim/scene.h"
#include "tests/services/mesher/shapes.h"

namespace nbs {

/// What a mesh is worth against the true surface. Vertices count if a triangle uses them.
struct MeshQuality {
  int64_t triangles = 0;
  int64_t edges = 0;
  int64_t border_edges = 0;
  int64_t spurious_border_edges = 0;  ///< Where all of the surface within 4 mm was measured at least three times.
  int64_t non_manifold_edges = 0;     ///< With more than two triangles.
  int64_t non_manifold_vertices = 0;  ///< With more than one fan.
  int64_t flipped_edges = 0;          ///< Whose two triangles do not agree on the side.
  int64_t degenerate_triangles = 0;   ///< A vertex twice, or less high than a thousandth of the longest side.
  int64_t joining_triangles = 0;      ///< With corners on two sheets.
  double completeness = 0.0;          ///< Eq. 3.
  double mean_edge_m = 0.0;
  double longest_edge_m = 0.0;
  double rms_error_m = 0.0;      ///< Of the vertices.
  double largest_error_m = 0.0;  ///< Of the vertices; those further than 10 mm off count as 10 mm.
  double ridge_gap_m = 0.0;      ///< Largest distance of the mesh from a ridge or corner that was measured.
  double coverage = 0.0;         ///< Of the surface that was measured at least three times.
  double measured = 0.0;         ///< Share of the whole surface that was.
};

/// Judges meshes of one shape, scanned by given stripes.
///
/// The truth is sampled evenly by area. A sample is measured as often as beams returned from within 1.5 mm of it, on
/// the same side; it is covered if the mesh has a point within 2 mm whose normal agrees within 75 degrees. A vertex
/// lies on the sheet of the nearest true triangle that faces its way.
class QualityOracle {
 public:
  /// @param stripes  Their poses must be true; the noise in their ranges does not matter much.
  QualityOracle(const Shape& shape, const Profiler& profiler, std::span<const Stripe> stripes, int samples);

  /// @param mesh_W  Its normals, if any, help to tell the sheets; otherwise the triangles' do.
  MeshQuality Evaluate(const TriangleMesh& mesh_W) const;

  const TriangleScene& truth_W() const { return truth_W_; }

 private:
  struct Sample {
    Eigen::Vector3d p_W;
    Eigen::Vector3d normal_W;
    int measurements = 0;
  };

  template <typename Visit>
  void ForEachSampleNear(const Eigen::Vector3d& p_W, float radius_m, Visit&& visit) const {
    grid_.ForEachCell(p_W.cast<float>(), radius_m, [&](int32_t head) {
      for (int32_t k = head; k != BrickGrid::kNone; k = next_[k]) {
        if ((samples_[k].p_W - p_W).norm() <= radius_m) visit(k);
      }
    });
  }
  void PlaceSamples(const TriangleMesh& mesh_W, int count);
  void CountMeasurements(const Profiler& profiler, std::span<const Stripe> stripes);
  void CompareVertices(const TriangleMesh& mesh_W, MeshQuality& quality) const;
  void CompareSamples(const TriangleMesh& mesh_W, MeshQuality& quality) const;
  void CompareRidges(const TriangleMesh& mesh_W, MeshQuality& quality) const;
  void CompareBorder(const TriangleMesh& mesh_W, MeshQuality& quality) const;

  std::vector<int> sheets_;
  std::vector<Eigen::Vector3d> ridges_W_;
  TriangleScene truth_W_;
  std::vector<Sample> samples_;
  // Samples by place: heads of lists that go on in next_.
  BrickGrid grid_;
  std::vector<int32_t> next_;
};

/// The counts and lengths alone, without a truth.
MeshQuality CalcTopologyFigures(const TriangleMesh& mesh_W);

}  // namespace nbs
